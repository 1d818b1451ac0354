//! How the problems of a record are listed.

/// Defines [`Problem`], one row a sentence: the code of its flag, its name and its values.
macro_rules! problems {
    ($($(#[$doc:meta])* $code:ident: $problem:ident $({ $($(#[$of:meta])* $field:ident: $type:ty),+ $(,)? })?;)*) => {
        /// What was found in a record and what was expected.
        #[derive(
            Debug, Default, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
        )]
        #[strum(serialize_all = "snake_case")]
        #[serde(tag = "kind", rename_all = "snake_case")]
        pub enum Problem {
            $($(#[$doc])* $problem $({ $($(#[$of])* $field: $type),+ })?,)*
        }

        impl Problem {
            /// The code of its flag.
            pub fn code(&self) -> FlagCode {
                match self {
                    $(Self::$problem { .. } => FlagCode::$code,)*
                }
            }
        }
    };
}
