//! Enums whose values have a word in files.

/// Defines an enum whose values have a word in files and on the command line.
///
/// The word is written once: [`Display`](std::fmt::Display) writes it, and with the features `serde`
/// and `schemars` of this crate a document holds it and its schema lists it.
#[macro_export]
macro_rules! words {
    (
        $(#[doc = $about:literal])+
        $vis:vis enum $kind:ident {
            $($(#[doc = $doc:literal])+ $value:ident => $word:literal,)+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        $vis enum $kind {
            $($(#[doc = $doc])+ $value,)+
        }

        impl $kind {
            /// Each value and its name in files and on the command line.
            pub const WORDS: &'static [(&'static str, Self)] = &[$(($word, Self::$value)),+];

            /// Name in files and on the command line.
            pub const fn word(self) -> &'static str {
                match self {
                    $(Self::$value => $word),+
                }
            }
        }

        impl ::std::fmt::Display for $kind {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                f.pad(self.word())
            }
        }

        $crate::words_in_files!($kind);
        $crate::words_in_schemas!($kind [$($about)+] { $($word: [$($doc)+],)+ });
    };
}

#[doc(hidden)]
#[cfg(not(feature = "serde"))]
#[macro_export]
macro_rules! words_in_files {
    ($($unused:tt)*) => {};
}

#[doc(hidden)]
#[cfg(not(feature = "schemars"))]
#[macro_export]
macro_rules! words_in_schemas {
    ($($unused:tt)*) => {};
}

#[doc(hidden)]
#[cfg(feature = "serde")]
#[macro_export]
macro_rules! words_in_files {
    ($kind:ident) => {
        impl $crate::words::serde::Serialize for $kind {
            fn serialize<S>(&self, to: S) -> ::std::result::Result<S::Ok, S::Error>
            where
                S: $crate::words::serde::Serializer,
            {
                to.serialize_str(self.word())
            }
        }

        impl<'de> $crate::words::serde::Deserialize<'de> for $kind {
            fn deserialize<D>(from: D) -> ::std::result::Result<Self, D::Error>
            where
                D: $crate::words::serde::Deserializer<'de>,
            {
                $crate::words::read(from, Self::WORDS)
            }
        }
    };
}

#[doc(hidden)]
#[cfg(feature = "schemars")]
#[macro_export]
macro_rules! words_in_schemas {
    ($kind:ident [$($about:literal)+] { $($word:literal: [$($doc:literal)+],)+ }) => {
        impl $crate::words::schemars::JsonSchema for $kind {
            fn schema_name() -> ::std::borrow::Cow<'static, str> {
                stringify!($kind).into()
            }

            fn schema_id() -> ::std::borrow::Cow<'static, str> {
                concat!(module_path!(), "::", stringify!($kind)).into()
            }

            fn json_schema(
                _: &mut $crate::words::schemars::SchemaGenerator,
            ) -> $crate::words::schemars::Schema {
                let words = [$(($word, concat!($($doc),+))),+];
                $crate::words::schema(concat!($($about),+), &words)
            }
        }
    };
}

#[cfg(feature = "schemars")]
pub use schemars;
#[cfg(feature = "serde")]
pub use serde;

/// Reads a word.
#[cfg(feature = "serde")]
pub fn read<'de, T: Copy, D: serde::Deserializer<'de>>(
    from: D,
    words: &[(&str, T)],
) -> Result<T, D::Error> {
    let found: String = serde::Deserialize::deserialize(from)?;
    let known = words.iter().find(|(word, _)| *word == found);
    known.map(|(_, value)| *value).ok_or_else(|| {
        let allowed: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        let allowed = allowed.join(", ");
        serde::de::Error::custom(format_args!("found '{found}'; allowed: {allowed}"))
    })
}

/// Schema of one of these words, each with what it means.
#[cfg(feature = "schemars")]
pub fn schema(about: &str, words: &[(&str, &str)]) -> schemars::Schema {
    let word = |(word, about): &(&str, &str)| schemars::json_schema!({ "const": word, "description": about.trim() });
    let words: Vec<_> = words.iter().map(word).collect();
    schemars::json_schema!({ "description": about.trim(), "type": "string", "oneOf": words })
}
