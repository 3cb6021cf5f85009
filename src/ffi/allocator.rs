//! The source of the library's memory: the system, or functions that the program sets.
//!
//! Rust's global allocator is one for all that is linked with one standard library. The C libraries have theirs for themselves and
//! make it this one (the feature `allocator`, which CMake enables); a Rust program has its own. Each block of memory remembers
//! behind its end where it came from and goes back there, so that the functions may be exchanged at any time.

use std::alloc::{GlobalAlloc, Layout, System};
use std::ffi::c_void;
use std::ptr::null_mut;
use std::sync::Mutex;
use std::sync::atomic::{AtomicPtr, Ordering};

use super::failure::{Failure, StatusCode};
use super::guard::guard;
use super::log::must_return;
use crate::base::locks::locked;

/// Allocates `size` bytes at an address that is a multiple of `alignment`. `size` is not 0 and a multiple of it, too. The alignment
/// is a power of two, at least that of a pointer, and may exceed malloc's (64, for example). `user` is the pointer given to
/// swiftprox_library_set_allocator.
///
/// Return null if there is no memory. Calls then end in SWIFTPROX_ERROR_MEMORY where memory grows with the input or a scene, or is
/// for integers. For other, small blocks the program ends with a message (see the head of this file).
pub type AllocateCallback =
    Option<unsafe extern "C-unwind" fn(user: *mut c_void, size: usize, alignment: usize) -> *mut c_void>;

/// Frees memory that the swiftprox_allocate_callback set with it returned for the same size and alignment. `user` is the pointer
/// given with both.
pub type DeallocateCallback =
    Option<unsafe extern "C-unwind" fn(user: *mut c_void, memory: *mut c_void, size: usize, alignment: usize)>;

/// The functions of a program.
#[derive(Clone, Copy)]
struct Functions {
    allocate: unsafe extern "C-unwind" fn(*mut c_void, usize, usize) -> *mut c_void,
    deallocate: unsafe extern "C-unwind" fn(*mut c_void, *mut c_void, usize, usize),
    user: *mut c_void,
}

// SAFETY: `user` is only ever handed back to the functions, which swiftprox_library_set_allocator requires to be callable from
// every thread.
unsafe impl Send for Functions {}
// SAFETY: as above.
unsafe impl Sync for Functions {}

impl Functions {
    fn are(&self, other: &Functions) -> bool {
        self.allocate as usize == other.allocate as usize
            && self.deallocate as usize == other.deallocate as usize
            && self.user == other.user
    }
}

/// Functions that were set once, in a list. They stay for ever: blocks may still come from them.
struct MemorySource {
    functions: Functions,
    before: Option<&'static MemorySource>,
}

/// All sources.
static SOURCES: Mutex<Option<&'static MemorySource>> = Mutex::new(None);

/// The source of new blocks; null for the system.
static CURRENT: AtomicPtr<MemorySource> = AtomicPtr::new(null_mut());

/// An allocator that takes memory from where swiftprox_library_set_allocator says.
///
/// Behind what a block is for stands its source, null for the system.
pub struct Replaceable;

// A unit test is linked with the library as well, which has it.
#[cfg(all(feature = "allocator", not(test)))]
#[global_allocator]
static ALLOCATOR: Replaceable = Replaceable;

/// What is taken for a block of this layout, and where in it its source stands. `None` for more than the address space holds.
fn with_source(layout: Layout) -> Option<(Layout, usize)> {
    let (whole, at) = layout.extend(Layout::new::<*mut MemorySource>()).ok()?;
    // aligned_alloc of C11 wants multiples of the alignment.
    Some((whole.pad_to_align(), at))
}

/// Writes the source behind a block, if there is one.
///
/// # Safety
/// `block` is null, or `at + 8` bytes of it can be written; at + block is aligned for a pointer.
unsafe fn sign(block: *mut u8, at: usize, source: *mut MemorySource) -> *mut u8 {
    if !block.is_null() {
        // SAFETY: by the caller.
        unsafe { block.add(at).cast::<*mut MemorySource>().write(source) };
    }
    block
}

// SAFETY: nothing unwinds, and what is given is as long and aligned as asked for if the functions of the program keep their
// contract (AllocateCallback). All blocks have been signed by `sign`.
unsafe impl GlobalAlloc for Replaceable {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let Some((whole, at)) = with_source(layout) else { return null_mut() };
        let source = CURRENT.load(Ordering::Acquire);
        // SAFETY: sources are never freed; the layout is not empty.
        let block = match unsafe { source.as_ref() } {
            Some(MemorySource { functions: f, .. }) => {
                // SAFETY: the functions take any size and alignment.
                must_return(|| unsafe { (f.allocate)(f.user, whole.size(), whole.align()) }).cast()
            }
            // SAFETY: the layout is not empty.
            None => unsafe { System.alloc(whole) },
        };
        // SAFETY: the block has `whole.size()` bytes, `at + 8` at least.
        unsafe { sign(block, at, source) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if !CURRENT.load(Ordering::Acquire).is_null() {
            // SAFETY: by the caller; the block can be written where there is one.
            return unsafe {
                let block = self.alloc(layout);
                if !block.is_null() {
                    block.write_bytes(0, layout.size());
                }
                block
            };
        }
        let Some((whole, at)) = with_source(layout) else { return null_mut() };
        // SAFETY: the layout is not empty; the block has `at + 8` bytes.
        unsafe { sign(System.alloc_zeroed(whole), at, null_mut()) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        let Some((whole, at)) = with_source(layout) else { return };
        // SAFETY: `block` was given for the same layout, so it was signed there; its source is good for ever.
        unsafe {
            match block.add(at).cast::<*mut MemorySource>().read().as_ref() {
                Some(MemorySource { functions: f, .. }) => {
                    must_return(|| (f.deallocate)(f.user, block.cast(), whole.size(), whole.align()));
                }
                None => System.dealloc(block, whole),
            }
        }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        let Ok(longer) = Layout::from_size_align(size, layout.align()) else { return null_mut() };
        let (Some((whole, at)), Some((new_whole, new_at))) = (with_source(layout), with_source(longer)) else {
            return null_mut();
        };
        // SAFETY: `block` was given for `layout`, so it was signed at `at`, and goes back with what it was taken with. The system
        // keeps what both blocks have in common; so does the copy.
        unsafe {
            let source = block.add(at).cast::<*mut MemorySource>().read();
            if source.is_null() && CURRENT.load(Ordering::Acquire).is_null() {
                return sign(System.realloc(block, whole, new_whole.size()), new_at, source);
            }
            let moved = self.alloc(longer);
            if !moved.is_null() {
                moved.copy_from_nonoverlapping(block, size.min(layout.size()));
                self.dealloc(block, layout);
            }
            moved
        }
    }
}

/// Sets the functions that allocate all memory of the library, for the whole process. Null for both (the default) means the
/// system's malloc. You may call this at any time: memory goes back to the functions it came from. So functions once set, and
/// `user`, must stay valid until the process ends. They are called at the end of threads and after main, too.
///
/// Several threads may call the functions at once. They must return and must not call the library; a C++ exception that leaves them
/// ends the program.
///
/// On failure nothing has changed. SWIFTPROX_ERROR_INVALID_ARGUMENT: only one function is null. SWIFTPROX_ERROR_UNSUPPORTED: the
/// library was built neither by CMake nor with Cargo's feature `allocator`; a Rust program's own allocator is used.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_set_allocator(
    allocate: AllocateCallback,
    deallocate: DeallocateCallback,
    user: *mut c_void,
) -> StatusCode {
    guard(|| {
        let functions = match (allocate, deallocate) {
            (Some(allocate), Some(deallocate)) => Some(Functions { allocate, deallocate, user }),
            (None, None) => None,
            (allocate, _) => {
                let name = if allocate.is_none() { "allocate" } else { "deallocate" };
                let message = format!("`{name}` is null and the other function is not");
                return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
            }
        };
        if !cfg!(feature = "allocator") {
            let message =
                "the library was built without the feature `allocator`, as for a Rust program, which has its own";
            return Err(Failure::new(StatusCode::ErrorUnsupported, message));
        }
        set(functions);
        Ok(())
    })
}

/// Sets the source of new blocks.
fn set(functions: Option<Functions>) {
    let source = functions.map_or(null_mut(), |functions| std::ptr::from_ref(source_of(functions)).cast_mut());
    CURRENT.store(source, Ordering::Release);
}

/// The source that these functions are, a new one the first time.
fn source_of(functions: Functions) -> &'static MemorySource {
    let mut sources = locked(&SOURCES);
    let mut known = *sources;
    while let Some(source) = known {
        if source.functions.are(&functions) {
            return source;
        }
        known = source.before;
    }
    let layout = Layout::new::<MemorySource>();
    // SAFETY: the layout is not empty; what is there is written before it is read, and stays. From the system: the program's
    // functions would miss it.
    let source = unsafe {
        let place = System.alloc(layout).cast::<MemorySource>();
        if place.is_null() {
            std::alloc::handle_alloc_error(layout);
        }
        place.write(MemorySource { functions, before: *sources });
        &*place
    };
    *sources = Some(source);
    source
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicIsize;

    /// A program's takings and returns, in blocks and bytes.
    #[derive(Default)]
    struct Account {
        blocks: AtomicIsize,
        bytes: AtomicIsize,
    }

    unsafe extern "C-unwind" fn take(user: *mut c_void, size: usize, alignment: usize) -> *mut c_void {
        assert!(size > 0 && size.is_multiple_of(alignment) && alignment.is_power_of_two() && alignment >= 8);
        // SAFETY: the test hands an account that is static.
        let account = unsafe { &*user.cast::<Account>() };
        account.blocks.fetch_add(1, Ordering::Relaxed);
        account.bytes.fetch_add(size as isize, Ordering::Relaxed);
        // SAFETY: the layout is not empty.
        unsafe { System.alloc(Layout::from_size_align(size, alignment).unwrap()) }.cast()
    }

    unsafe extern "C-unwind" fn give_back(user: *mut c_void, memory: *mut c_void, size: usize, alignment: usize) {
        // SAFETY: as above.
        let account = unsafe { &*user.cast::<Account>() };
        account.blocks.fetch_sub(1, Ordering::Relaxed);
        account.bytes.fetch_sub(size as isize, Ordering::Relaxed);
        // SAFETY: taken by `take` with the same layout.
        unsafe { System.dealloc(memory.cast(), Layout::from_size_align(size, alignment).unwrap()) };
    }

    fn functions(account: &'static Account) -> Option<Functions> {
        Some(Functions { allocate: take, deallocate: give_back, user: std::ptr::from_ref(account).cast_mut().cast() })
    }

    /// One test: what is set is the process's own.
    #[test]
    fn blocks_go_back_where_they_came_from_and_keep_what_they_hold() {
        static ACCOUNTS: [Account; 2] =
            [const { Account { blocks: AtomicIsize::new(0), bytes: AtomicIsize::new(0) } }; 2];
        let count = |i: usize| ACCOUNTS[i].blocks.load(Ordering::Relaxed);
        let settings = [functions(&ACCOUNTS[0]), None, functions(&ACCOUNTS[1]), functions(&ACCOUNTS[0])];
        let lasting = |i: usize| std::ptr::from_ref(source_of(settings[i].unwrap()));
        // Under Miri a function has another address each time it is asked for.
        assert!(cfg!(miri) || lasting(0) == lasting(3), "functions set again are no new source");
        assert!(lasting(0) != lasting(2));

        for (size, alignment) in [(1, 1), (7, 8), (8, 8), (9, 1), (64, 64), (100, 16), (1000, 4096)] {
            let [layout, grown, shrunk] =
                [size, 3 * size, 1].map(|size| Layout::from_size_align(size, alignment).unwrap());
            for (first, then) in settings.iter().flat_map(|first| settings.iter().map(move |then| (first, then))) {
                set(*first);
                // SAFETY: the layouts are not empty; blocks are used as such of the layouts that they were given for.
                unsafe {
                    let block = Replaceable.alloc(layout);
                    block.write_bytes(7, size);
                    let zeroed = Replaceable.alloc_zeroed(layout);
                    assert!((0..size).all(|k| zeroed.add(k).read() == 0));
                    Replaceable.dealloc(zeroed, layout);
                    assert!(first.is_none() || count(0).max(count(1)) >= 1);

                    set(*then);
                    let longer = Replaceable.realloc(block, layout, grown.size());
                    assert!((0..size).all(|k| longer.add(k).read() == 7));
                    let shorter = Replaceable.realloc(longer, grown, shrunk.size());
                    assert_eq!(shorter.read(), 7);
                    assert!([block, longer, shorter].iter().all(|block| block.addr().is_multiple_of(alignment)));
                    Replaceable.dealloc(shorter, shrunk);
                }
                set(None);
                if !cfg!(feature = "allocator") {
                    let bytes = ACCOUNTS.each_ref().map(|account| account.bytes.load(Ordering::Relaxed));
                    assert_eq!(([count(0), count(1)], bytes), ([0, 0], [0, 0]));
                }
            }
        }
    }

    #[test]
    fn a_layout_beyond_the_address_space_gets_no_block() {
        let layout = Layout::from_size_align(isize::MAX as usize - 7, 8).unwrap();
        // SAFETY: the layout is not empty.
        let blocks = unsafe { [Replaceable.alloc(layout), Replaceable.alloc_zeroed(layout)] };
        assert!(blocks.iter().all(|block| block.is_null()));
    }
}
