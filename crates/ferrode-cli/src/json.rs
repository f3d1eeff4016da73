//! JSON objects whose members keep their order.

use serde_json::Value;
use std::fmt;

/// An object, as a list of members.
#[derive(Clone, Debug, Default)]
pub struct Object(Vec<(&'static str, String)>);

impl Object {
    /// The same with one more member. Numbers that JSON does not have (NaN, ∞) become null.
    pub fn with(mut self, name: &'static str, value: impl Into<Value>) -> Self {
        self.0.push((name, value.into().to_string()));
        self
    }
}

impl fmt::Display for Object {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("{")?;
        for (index, (name, value)) in self.0.iter().enumerate() {
            let comma = if index > 0 { "," } else { "" };
            write!(f, "{comma}{}:{value}", Value::from(*name))?;
        }
        f.write_str("}")
    }
}

#[cfg(test)]
mod tests {
    use super::Object;

    #[test]
    fn members_keep_their_order_and_text_its_quotes() {
        let object = Object::default().with("b", 1.5).with("a", "say \"x\"\n").with("n", f64::NAN);
        assert_eq!(object.to_string(), r#"{"b":1.5,"a":"say \"x\"\n","n":null}"#);
    }
}
