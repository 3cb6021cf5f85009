//! What the shared library exports: functions of our nouns, and nothing that the runtime of the Swift language, which may live in the
//! same process, exports under the same prefix. Needs `nm`; without it nothing is tested.

use std::path::PathBuf;
use std::process::Command;

/// The nouns of the C interface.
const NOUNS: [&str; 5] = ["library", "shape", "pair", "object", "scene"];

/// First words behind `swift_` of the entry points that docs/Runtime.md of github.com/swiftlang/swift lists, and of its libraries
/// for concurrency, time and reflection. Most go on in camel case, which our names never do; a noun that is such a word
/// could one day be theirs in full.
const RUNTIME_WORDS: &str = "
    alloc allocBox allocError allocObject allocateGenericClassMetadata allocateGenericValueMetadata
    assignExistentialWithCopy asyncLet bridgeErrorTypeToNSError bridgeNonVerbatimFromObjectiveC bridgeObjectRelease
    bridgeObjectRetain bufferAllocate bufferHeaderSize class clock conformsToProtocol continuation copyPOD dealloc
    deallocBox deallocClassInstance deallocError deallocObject deallocPartialClassInstance distributed dynamicCast
    dynamicCastClass errorRelease errorRetain executor get getDynamicType getEnumCaseMultiPayload getErrorValue
    getGenericMetadata getObjectType getTypeName initClassMetadata initEnumMetadataMultiPayload initStackObject
    initializeSuperclass instantiateObjCClass isClassType isDeallocating isOptionalType isUniquelyReferenced job
    objc objcRespondsToSelector once projectBox reflectAny reflectionMirror registerProtocolConformances release
    reportError reportMissingMethod retain retainCount rootObjCDealloc slowAlloc slowDealloc stdlib
    storeEnumTagMultiPayload task taskGroup time tryPin tryRetain unknownRelease unknownRetain unknownWeakAssign
    unownedCheck unownedRelease unownedRetain unpin verifyEndOfLifetime weakAssign weakDestroy weakInit weakLoadStrong
    willThrow";

/// The shared library that this test run built.
fn library() -> Option<PathBuf> {
    let folder = std::env::current_exe().ok()?.parent()?.parent()?.to_path_buf();
    Some(folder.join("libswiftprox.so")).filter(|path| path.exists())
}

/// Names of the dynamic symbols that are defined, or none where there is no `nm` or no such library.
fn exports() -> Option<Vec<String>> {
    let output = Command::new("nm").args(["-D", "--defined-only"]).arg(library()?).output().ok()?;
    assert!(output.status.success(), "nm: {}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("symbols are plain");
    Some(text.lines().filter_map(|line| line.split_whitespace().last()).map(str::to_string).collect())
}

#[test]
fn only_functions_of_our_nouns_are_exported() {
    let Some(exports) = exports() else {
        println!("no nm, or no shared library: not tested");
        return;
    };
    let header = include_str!("../include/swiftprox.h");
    assert!(exports.len() > 30, "{exports:?}");
    for name in exports {
        let word = name.strip_prefix("swift_").unwrap_or_else(|| panic!("{name} is exported without the prefix"));
        let noun = word.split('_').next().unwrap_or_default();
        assert!(NOUNS.contains(&noun), "{name}: `{noun}` is no noun of the interface");
        assert!(header.contains(&format!("{name}(")), "{name} is exported and not in the header");
    }
}

#[test]
fn every_function_of_the_header_is_exported() {
    let Some(exports) = exports() else {
        println!("no nm, or no shared library: not tested");
        return;
    };
    for line in include_str!("../include/swiftprox.h").lines() {
        let declares = ["swift_status swift_", "const char *swift_", "void swift_"].iter().any(|s| line.starts_with(s));
        if let Some((declaration, _)) = line.split_once('(')
            && declares
        {
            let name = declaration.split([' ', '*']).next_back().unwrap_or_default();
            assert!(exports.iter().any(|export| export == name), "{name} is not exported");
        }
    }
}

#[test]
fn no_noun_of_ours_is_a_word_of_the_swift_runtime() {
    for noun in NOUNS {
        assert!(
            RUNTIME_WORDS.split_whitespace().all(|word| word != noun),
            "swift_{noun}… may be a function of the Swift runtime"
        );
    }
}
