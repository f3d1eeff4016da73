//! The chapters of `docs/book`, so that their code is compiled and run with the documentation tests. The packaged crate
//! does not contain them.

macro_rules! chapters {
    ($($name:ident = $path:literal;)+) => {
        $(#[doc = include_str!(concat!("../../../docs/book/", $path))] struct $name;)+
    };
}

chapters! {
    Introduction = "introduction.md";
    Install = "install.md";
    Concepts = "concepts.md";
    Typical = "typical.md";
    ErpCfm = "erp_cfm.md";
    Friction = "friction.md";
    DataTypes = "data_types.md";
    WorldChapter = "world.md";
    Bodies = "bodies.md";
}
