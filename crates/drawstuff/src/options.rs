//! The options that every program takes.

/// What the command line asks for. Other words are the program's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// With textures.
    pub textures: bool,
    /// With shadows.
    pub shadows: bool,
    /// Begin paused.
    pub paused: bool,
}

impl Options {
    /// Reads arguments, without the program's name.
    pub fn parse(arguments: &[String]) -> Self {
        let has = |name: &str| arguments.iter().any(|argument| argument == name);
        // `-texturepath DIR` is taken and has no effect: textures are computed.
        Self {
            textures: !has("-notex"),
            shadows: !(has("-noshadow") || has("-noshadows")),
            paused: has("-pause"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Options;

    #[test]
    fn words_switch_things_off() {
        let parse = |line: &str| {
            let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
            let Options { textures, shadows, paused } = Options::parse(&words);
            (textures, shadows, paused)
        };
        assert_eq!(parse(""), (true, true, false));
        assert_eq!(parse("-notex -pause -own 3"), (false, true, true));
        assert_eq!(parse("-noshadows -texturepath /x"), (true, false, false));
        assert_eq!(parse("-noshadow"), (true, false, false));
    }
}
