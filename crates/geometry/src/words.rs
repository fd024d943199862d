//! Names of values.

/// Defines the names that the values of an enum have in files and on the command line.
#[macro_export]
macro_rules! words {
    ($kind:ty { $($value:ident => $word:literal),+ $(,)? }) => {
        impl $kind {
            /// Each value and its name in files and on the command line.
            pub const WORDS: &'static [(&'static str, Self)] = &[$(($word, Self::$value)),+];

            /// Name in files and on the command line.
            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$value => $word),+
                }
            }
        }
    };
}
