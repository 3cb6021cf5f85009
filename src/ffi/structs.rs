//! Structs that know their size: a caller with an older or a newer header has another one.

use std::mem::MaybeUninit;

use super::failure::{Checked, Failure, StatusCode};

/// No struct of this interface is smaller than struct_size and one member: such a struct_size was never initialised.
const SMALLEST_STRUCT: usize = 16;

/// No struct of this interface will ever be larger: as above.
const LARGEST_STRUCT: usize = 4096;

/// A C struct that begins with its own size, as the caller's compiler knows it, so that it can grow. New members go to its end,
/// never into padding, and by zero mean what was done before there were any.
///
/// # Safety
/// The type is `repr(C)`, its first member is the `usize` struct_size, and any bytes make a valid one.
pub(super) unsafe trait Versioned: Copy {
    /// Its name in the header.
    const NAME: &'static str;
}

/// Refuses what is no size of a struct.
fn check_struct_size<T: Versioned>(size: usize) -> Checked<()> {
    if (SMALLEST_STRUCT..=LARGEST_STRUCT).contains(&size) {
        return Ok(());
    }
    let name = T::NAME;
    let cure = if name.ends_with("_info") {
        format!("set it to sizeof({name}) first")
    } else {
        format!("begin with {}_DEFAULT", name.to_uppercase())
    };
    Err(Failure::new(StatusCode::ErrorStructSize, format!("{name}: struct_size is {size}; {cure}")))
}

/// Writes what follows struct_size, `size` bytes with it: as much of `value` as fits, and zeros behind it.
///
/// # Safety
/// `pointer` points to `size` writable bytes, [`SMALLEST_STRUCT`] at least.
unsafe fn fill<T: Versioned>(pointer: *mut T, size: usize, value: &T) {
    let start = size_of::<usize>();
    let end = size.min(size_of::<T>());
    // SAFETY: both places have `end` bytes, and the caller's has `size`.
    unsafe {
        let source = (&raw const *value).cast::<u8>();
        pointer.cast::<u8>().add(start).copy_from_nonoverlapping(source.add(start), end - start);
        pointer.cast::<u8>().add(end).write_bytes(0, size - end);
    }
}

/// Copies a caller's struct of any size over `defaults`, which stay where an older struct ends, or wholly for null. Refuses one of
/// a newer header that sets what this library does not know.
///
/// # Safety
/// `pointer` is null or points to as many readable bytes as its struct_size says.
pub(super) unsafe fn read_struct<T: Versioned>(pointer: *const T, defaults: T) -> Checked<T> {
    if pointer.is_null() {
        return Ok(defaults);
    }
    // SAFETY: struct_size is the first member.
    let size = unsafe { pointer.cast::<usize>().read() };
    check_struct_size::<T>(size)?;
    for offset in size_of::<T>()..size {
        // SAFETY: below struct_size, readable by the caller.
        if unsafe { pointer.cast::<u8>().add(offset).read() } != 0 {
            let message = format!(
                "{}: the program's header is newer than this library ({}), which does not know the member at offset {offset}; \
                 leave it 0, or take a newer library",
                T::NAME,
                env!("CARGO_PKG_VERSION"),
            );
            return Err(Failure::new(StatusCode::ErrorStructSize, message));
        }
    }
    let mut value = MaybeUninit::new(defaults);
    // SAFETY: as many bytes are readable there and fit here; two different places. Any bytes make a valid struct.
    unsafe {
        value.as_mut_ptr().cast::<u8>().copy_from_nonoverlapping(pointer.cast::<u8>(), size.min(size_of::<T>()));
        Ok(value.assume_init())
    }
}

/// A caller's struct where it is, if it has today's size: nothing is copied. Else `older` holds what [`read_struct`] makes of it.
///
/// # Safety
/// `pointer` is not null and points to as many readable bytes as its struct_size says, unchanged for `'a`.
#[inline(always)]
pub(super) unsafe fn view_struct<'a, T: Versioned>(
    pointer: *const T,
    defaults: &T,
    older: &'a mut MaybeUninit<T>,
) -> Checked<&'a T> {
    // SAFETY: not null; struct_size is the first member.
    if unsafe { pointer.cast::<usize>().read() } == size_of::<T>() {
        // SAFETY: as large as today's struct, of which any bytes are valid.
        return Ok(unsafe { &*pointer });
    }
    // SAFETY: by the caller.
    Ok(older.write(unsafe { read_struct(pointer, *defaults) }?))
}

/// Fills a caller's info as far as its struct_size says; what only a newer header knows becomes zero.
///
/// # Safety
/// `pointer` is null or points to as many writable bytes as its struct_size says.
pub(super) unsafe fn write_struct<T: Versioned>(pointer: *mut T, name: &str, value: &T) -> Checked<()> {
    if pointer.is_null() {
        return Err(Failure::null(name));
    }
    // SAFETY: struct_size is the first member.
    let size = unsafe { pointer.cast::<usize>().read() };
    check_struct_size::<T>(size)?;
    // SAFETY: by the caller.
    unsafe { fill(pointer, size, value) };
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::offset_of;

    /// A struct to which `newer` was added.
    #[derive(Debug, Clone, Copy, PartialEq)]
    #[repr(C)]
    struct Grown {
        struct_size: usize,
        older: f64,
        newer: f64,
    }

    // SAFETY: repr(C), struct_size first, any bytes are valid.
    unsafe impl Versioned for Grown {
        const NAME: &'static str = "swiftprox_grown";
    }

    const OLDER_SIZE: usize = offset_of!(Grown, newer);

    const DEFAULTS: Grown = Grown { struct_size: size_of::<Grown>(), older: 1.0, newer: 2.0 };

    /// A newer header's form of it.
    #[derive(Debug, Clone, Copy, PartialEq)]
    #[repr(C)]
    struct Newest {
        known: Grown,
        unknown: [f64; 2],
    }

    #[test]
    fn a_struct_of_an_older_header_keeps_the_defaults_of_what_it_lacks() {
        let given = Grown { struct_size: OLDER_SIZE, older: 3.0, newer: 4.0 };
        // SAFETY: a live struct, larger than it says.
        let read = unsafe { read_struct(&given, DEFAULTS) }.unwrap();
        assert_eq!((read.older, read.newer), (3.0, 2.0));
        let whole = Grown { struct_size: size_of::<Grown>(), ..given };
        // SAFETY: a live struct, as large as it says; null; one that is too small to be any.
        let [whole, null, small] = unsafe {
            let small = Grown { struct_size: SMALLEST_STRUCT - 1, ..given };
            [read_struct(&whole, DEFAULTS), read_struct(std::ptr::null(), DEFAULTS), read_struct(&small, DEFAULTS)]
        };
        assert_eq!(whole.unwrap().newer, 4.0);
        assert_eq!(null.unwrap(), DEFAULTS);
        let refused = small.unwrap_err();
        assert_eq!(refused.status, StatusCode::ErrorStructSize);
        assert!(refused.message.contains("SWIFTPROX_GROWN_DEFAULT"), "{}", refused.message);
    }

    #[test]
    fn nothing_is_written_beyond_the_end_of_an_older_struct() {
        let mut given = Grown { struct_size: OLDER_SIZE, older: 3.0, newer: 4.0 };
        // SAFETY: a live struct, larger than it says.
        unsafe { write_struct(&raw mut given, "info", &DEFAULTS) }.unwrap();
        assert_eq!(given, Grown { struct_size: OLDER_SIZE, older: 1.0, newer: 4.0 });
    }

    #[test]
    fn what_a_newer_header_adds_is_zero_or_refused() {
        let size = size_of::<Newest>();
        let mut given = Newest { known: Grown { struct_size: size, ..DEFAULTS }, unknown: [0.0; 2] };
        let pointer = (&raw mut given).cast::<Grown>();
        // SAFETY: a live struct, as large as it says.
        unsafe {
            assert_eq!(read_struct(pointer, DEFAULTS).unwrap().newer, 2.0);
            (&raw mut (*pointer.cast::<Newest>()).unknown).write([0.0, 7.0]);
            let refused = read_struct(pointer, DEFAULTS).unwrap_err();
            assert_eq!(refused.status, StatusCode::ErrorStructSize);
            assert!(refused.message.contains("offset"), "{}", refused.message);
            write_struct(pointer, "info", &DEFAULTS).unwrap();
            assert_eq!((pointer.cast::<Newest>().read()).unknown, [0.0; 2]);
        }
    }
}
