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

/// Reads a word. The error for another word, null, a number or a truth value names it and the words allowed.
#[cfg(feature = "serde")]
pub fn read<'de, T: Copy, D: serde::Deserializer<'de>>(
    from: D,
    words: &[(&str, T)],
) -> Result<T, D::Error> {
    let allowed = listed(words);
    let found = from.deserialize_any(Text { allowed: &allowed })?;
    let known = words.iter().find(|(word, _)| *word == found);
    known
        .map(|(_, value)| *value)
        .ok_or_else(|| refused(format_args!("'{found}'"), &allowed))
}

/// Reads the text of a place that usually holds one of these words. Another word is accepted; the
/// error for null, a number or a truth value names the words allowed.
#[cfg(feature = "serde")]
pub fn read_text<'de, T, D: serde::Deserializer<'de>>(
    from: D,
    words: &[(&str, T)],
) -> Result<String, D::Error> {
    let allowed = listed(words);
    from.deserialize_any(Text { allowed: &allowed })
}

/// The words, with commas between them.
#[cfg(feature = "serde")]
fn listed<T>(words: &[(&str, T)]) -> String {
    let words: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
    words.join(", ")
}

#[cfg(feature = "serde")]
fn refused<E: serde::de::Error>(found: impl std::fmt::Display, allowed: &str) -> E {
    E::custom(format_args!("found {found}; allowed: {allowed}"))
}

/// Reads a text. Numbers, truth values and null are named with the words allowed.
#[cfg(feature = "serde")]
struct Text<'a> {
    /// The words allowed, with commas between them.
    allowed: &'a str,
}

#[cfg(feature = "serde")]
impl serde::de::Visitor<'_> for Text<'_> {
    type Value = String;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "one of {}", self.allowed)
    }

    fn visit_str<E: serde::de::Error>(self, found: &str) -> Result<String, E> {
        Ok(found.to_owned())
    }

    fn visit_unit<E: serde::de::Error>(self) -> Result<String, E> {
        Err(refused("null", self.allowed))
    }

    fn visit_bool<E: serde::de::Error>(self, found: bool) -> Result<String, E> {
        Err(refused(found, self.allowed))
    }

    fn visit_i64<E: serde::de::Error>(self, found: i64) -> Result<String, E> {
        Err(refused(found, self.allowed))
    }

    fn visit_u64<E: serde::de::Error>(self, found: u64) -> Result<String, E> {
        Err(refused(found, self.allowed))
    }

    fn visit_f64<E: serde::de::Error>(self, found: f64) -> Result<String, E> {
        Err(refused(found, self.allowed))
    }
}

/// Schema of one of these words, each with what it means.
#[cfg(feature = "schemars")]
pub fn schema(about: &str, words: &[(&str, &str)]) -> schemars::Schema {
    let word = |(word, about): &(&str, &str)| schemars::json_schema!({ "const": word, "description": about.trim() });
    let words: Vec<_> = words.iter().map(word).collect();
    schemars::json_schema!({ "description": about.trim(), "type": "string", "oneOf": words })
}
