//! Enumerators from the numbers that stand for them in C and in files.

/// An enum whose variants travel as numbers.
pub trait Enumerator: Sized {
    /// The variant of a number, if it has one.
    fn from_number(number: i32) -> Option<Self>;
}

/// Implements [`Enumerator`] for an enum of `repr(i32)`; a variant that is missing in the list does not compile.
macro_rules! enumerator {
    ($type:ident { $($variant:ident),+ }) => {
        impl $crate::base::enumerator::Enumerator for $type {
            #[inline(always)]
            fn from_number(number: i32) -> Option<Self> {
                const _: fn($type) = |all| match all {
                    $($type::$variant => ()),+
                };
                $(if number == $type::$variant as i32 {
                    return Some($type::$variant);
                })+
                None
            }
        }
    };
}
pub(crate) use enumerator;
