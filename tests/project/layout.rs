//! Where the members of C's structs stand. c_tests/abi/layout.h has the numbers: here Rust's layout is compared with them, in
//! c_tests/abi/layout.c that of the C compiler. `BLESS=1 cargo test --test project layout` rewrites them.

use crate::headers::headers;
use std::fmt::Write;
use std::fs;
use std::mem::{align_of, offset_of, size_of};
use std::path::Path;
use std::process::Command;

use swiftprox::compound::{
    CompoundAnswer, CompoundCastAnswer, CompoundContact, CompoundDepth, CompoundPointAnswer, CompoundRayAnswer,
    CompoundSignedDistance,
};
use swiftprox::ffi::arrays::CMesh;
use swiftprox::ffi::compound::{CCompoundCache, CCompoundContacts, CMovingCompound, CPlacedCompound, CompoundInfo};
use swiftprox::ffi::decomposition::CDecomposition;
use swiftprox::ffi::depth::{CDepthCache, CDepthConfig, CManifoldCache, CManifoldConfig, CManifoldRoom};
use swiftprox::ffi::draw::CDraw;
use swiftprox::ffi::ground::{CGroundRoom, CPlacedGround, GroundCount, GroundInfo};
use swiftprox::ffi::level::LevelInfo;
use swiftprox::ffi::listener::CListenerEvents;
use swiftprox::ffi::motion::{CCastConfig, CClearanceConfig, CMotion, CMoving};
use swiftprox::ffi::object::{CObjectOptions, ObjectInfo};
use swiftprox::ffi::object_query::CSceneEvents;
use swiftprox::ffi::object_set::{CMotions, CObjectSet, CPath, CSceneRayAnswer};
use swiftprox::ffi::pair::{CPairCache, CPairConfig, CPlaced};
use swiftprox::ffi::pair_batch::{CPairQuestion, CPoses};
use swiftprox::ffi::query::{CSceneAnswer, CSceneQuery};
use swiftprox::ffi::record::CReplayStep;
use swiftprox::ffi::scene::CSceneOptions;
use swiftprox::ffi::scene_ground::{CSceneGroundAnswer, CSceneGroundConfig};
use swiftprox::ffi::shape::{CFace, CFaceRoom, ShapeInfo};
use swiftprox::ffi::shape_options::CShapeOptions;
use swiftprox::ffi::tuning::{CPairTuning, CShapeTuning, TuningInfo};
use swiftprox::ground::{GroundCastAnswer, GroundContact, GroundDistance, GroundRayAnswer};
use swiftprox::manifold::{Manifold, ManifoldPoint};
use swiftprox::motion::{CastAnswer, Clearance};
use swiftprox::object::ObjectId;
use swiftprox::pair::{
    DepthAnswer, DepthStatistics, Feature, Gradient, HalfSpace, PairAnswer, SignedDistance, Statistics,
};
use swiftprox::point::{PointAnswer, SupportVertex};
use swiftprox::ray::{Ray, RayAnswer};
use swiftprox::scene::{
    Contact, FirstHit, LeastDistance, ObjectPair, PairEvent, PairResult, PointEvent, SceneCastAnswer,
    SceneGroundContact, SceneRayHit, SceneStatistics,
};

const TABLE: &str = "c_tests/abi/layout.h";

/// The head of the table.
const HEAD: &str = "\
/*
 * The layout of C's structs where pointers have 64 bits. Written by Rust, compared by layout.c.
 *
 *   STRUCT(type, size, alignment)    MEMBER(type, member, offset, size)
 *
 * `BLESS=1 cargo test --test project layout` rewrites it.
 */
";

struct Layout {
    name: &'static str,
    size: usize,
    alignment: usize,
    /// Name, offset and size of each member.
    members: Vec<(&'static str, usize, usize)>,
}

fn size_of_member<T, M>(_: impl Fn(&T) -> &M) -> usize {
    size_of::<M>()
}

macro_rules! layouts {
    ($($name:ident = $rust:ty { $($member:ident),* },)*) => {
        vec![$(Layout {
            name: stringify!($name),
            size: size_of::<$rust>(),
            alignment: align_of::<$rust>(),
            members: vec![$((
                stringify!($member),
                offset_of!($rust, $member),
                size_of_member(|whole: &$rust| &whole.$member),
            )),*],
        }),*]
    };
}

/// Every struct of the headers, in their order.
#[rustfmt::skip]
fn layouts() -> Vec<Layout> {
    let mut all = layouts! {
        swiftprox_shape_options = CShapeOptions {
            struct_size, input, rotation, translation, scale, convexity_tolerance, progress, progress_user,
            tuning, face_noise, swept_radius
        },
        swiftprox_mesh = CMesh { vertices, vertex_count, indices, valences, face_count },
        swiftprox_shape_info = ShapeInfo {
            struct_size, dimension, vertex_count, edge_count, face_count, triangle_count, volume,
            centre_of_mass, radius, lower_corner, upper_corner, bytes, inertia, swept_radius, deviation
        },
        swiftprox_feature = Feature { kind, ids },
        swiftprox_statistics = Statistics { marching_steps, fallback_iterations, exact_iterations, levels },
        swiftprox_pair_answer = PairAnswer {
            outcome, decided_by, distance, lower, upper, local1, local2, world1, world2, normal, feature1,
            feature2, proof, proof_count, statistics
        },
        swiftprox_placed = CPlaced { shape, pose },
        swiftprox_pair_cache = CPairCache { words },
        swiftprox_pair_config = CPairConfig {
            struct_size, max_distance, absolute_error, relative_error, step_budget,
            tuning
        },
        swiftprox_depth_statistics = DepthStatistics { steps, supports, triangles, exact_iterations },
        swiftprox_depth_answer = DepthAnswer {
            outcome, ending, depth, lower, upper, local1, local2, world1, world2, normal, feature1,
            feature2, statistics
        },
        swiftprox_depth_cache = CDepthCache { words },
        swiftprox_depth_config = CDepthConfig {
            struct_size, absolute_error, relative_error, step_budget
        },
        swiftprox_manifold_cache = CManifoldCache { words },
        swiftprox_signed_distance = SignedDistance {
            outcome, distance, lower, upper, local1, local2, world1, world2, normal, feature1, feature2
        },
        swiftprox_manifold_point = ManifoldPoint {
            local1, local2, world1, world2, gap_lower, gap_upper, feature1, feature2, id
        },
        swiftprox_manifold = Manifold { outcome, reference, lower, upper, normal, point_count, found_count },
        swiftprox_manifold_room = CManifoldRoom { points, capacity, distance },
        swiftprox_manifold_config = CManifoldConfig { struct_size, max_distance, reduces },
        swiftprox_scene_options = CSceneOptions {
            struct_size, worker_count, enqueue_task, finish_task, task_user
        },
        swiftprox_object_options = CObjectOptions { struct_size, user_data, pose, fixed, groups, mask, ground, compound },
        swiftprox_object_info = ObjectInfo {
            struct_size, user_data, piece_count, pose, fixed, groups, mask, ground, compound
        },
        swiftprox_scene_query = CSceneQuery {
            struct_size, max_distance, absolute_error, relative_error, error_budget, step_budget,
            early_exit, tuning, detail, mask, piece_pairs
        },
        swiftprox_pair_result = PairResult {
            object1, object2, user_data1, user_data2, piece1, piece2, answer
        },
        swiftprox_scene_answer = CSceneAnswer {
            pairs, count, intersecting, found, contacts, contact_count, points, point_count
        },
        swiftprox_contact = Contact { depth, manifold, first_point },
        swiftprox_pair_event = PairEvent {
            object1, object2, user_data1, user_data2, piece_user_data1, piece_user_data2, piece1, piece2, state,
            objects_state, result, first_point, point_count
        },
        swiftprox_point_event = PointEvent { id, point, state },
        swiftprox_listener_events = CListenerEvents { pairs, count, points, point_count },
        swiftprox_poses = CPoses { shape, poses, count },
        swiftprox_pair_question = CPairQuestion { shape1, pose1, shape2, pose2, cache },
        swiftprox_object_pair = ObjectPair { object1, object2, user_data1, user_data2 },
        swiftprox_scene_events = CSceneEvents { began, began_count, ended, ended_count },
        swiftprox_scene_statistics = SceneStatistics {
            queries, pairs, marched, coherent, fallback, exact, marching_steps, fallback_iterations,
            exact_iterations, within_tolerance, budget_spent, by_level, error_spent, bounding_spheres,
            inscribed_spheres, unmoved, out_of_reach
        },
        swiftprox_object_set = CObjectSet { ids, count, poses, among },
        swiftprox_least_distance = LeastDistance { lower, upper, nearest },
        swiftprox_first_hit = FirstHit { time, tried, pair },
        swiftprox_path = CPath { poses, time_count, order },
        swiftprox_motion = CMotion {
            kind, start, end, centre, velocity, rotation, pose, user, bend, rounding
        },
        swiftprox_cast_answer = CastAnswer {
            outcome, queries, time_lower, time_upper, clearance, upper, time_parted, contact, proof, proof_count
        },
        swiftprox_cast_config = CCastConfig {
            struct_size, time_begin, time_end, time_tolerance, max_distance, step_budget, ignores_parting
        },
        swiftprox_moving = CMoving { shape, motion },
        swiftprox_clearance = Clearance { lower, upper, time, queries },
        swiftprox_clearance_config = CClearanceConfig {
            struct_size, time_begin, time_end, absolute_error, relative_error, step_budget
        },
        swiftprox_scene_cast_answer = SceneCastAnswer { outcome, queries, time_lower, time_upper, upper, pair },
        swiftprox_motions = CMotions { motions, count, edge_count },
        swiftprox_half_space = HalfSpace { normal, offset },
        swiftprox_ground_info = GroundInfo { vertex_count, triangle_count, bytes },
        swiftprox_placed_ground = CPlacedGround { ground, pose },
        swiftprox_ground_distance = GroundDistance { answer, triangle },
        swiftprox_ground_ray_answer = GroundRayAnswer { answer, triangle },
        swiftprox_ground_cast_answer = GroundCastAnswer { answer, triangle },
        swiftprox_ground_contact = GroundContact { manifold, triangle, first_point },
        swiftprox_ground_room = CGroundRoom { contacts, contact_capacity, points, point_capacity },
        swiftprox_ground_count = GroundCount { contact_count, point_count },
        swiftprox_scene_ground_config = CSceneGroundConfig { struct_size, max_distance, reduces, groups, mask },
        swiftprox_scene_ground_contact = SceneGroundContact { object, user_data, ground, piece, contact },
        swiftprox_scene_ground_answer = CSceneGroundAnswer { contacts, contact_count, points, point_count },
        swiftprox_face = CFace { normal, offset, corner_count, label_count },
        swiftprox_face_room = CFaceRoom { corners, corner_capacity, labels, label_capacity },
        swiftprox_decomposition = CDecomposition { corners, faces, pieces, capacity, triangle_count, piece_count },
        swiftprox_ray = Ray { origin, direction, t_max },
        swiftprox_ray_answer = RayAnswer { outcome, exact, entry, exit, normal, feature, steps },
        swiftprox_scene_ray_hit = SceneRayHit { object, user_data, piece, row, answer },
        swiftprox_scene_ray_answer = CSceneRayAnswer { hits, count },
        swiftprox_point_answer = PointAnswer { location, feature, distance, lower, upper, local, world, normal },
        swiftprox_support_vertex = SupportVertex { vertex, exact, local, world, height },
        swiftprox_gradient = Gradient { object1, object2, is_unique },
        swiftprox_compound_info = CompoundInfo { piece_count, bytes },
        swiftprox_placed_compound = CPlacedCompound { compound, pose },
        swiftprox_compound_cache = CCompoundCache { words },
        swiftprox_compound_answer = CompoundAnswer { answer, piece1, piece2 },
        swiftprox_compound_signed_distance_answer = CompoundSignedDistance { distance, piece1, piece2 },
        swiftprox_compound_depth_answer = CompoundDepth { deepest, lower, upper, translation },
        swiftprox_compound_contact = CompoundContact { manifold, first_point, piece1, piece2 },
        swiftprox_compound_contacts = CCompoundContacts {
            contacts, contact_capacity, points, point_capacity, contact_count, point_count
        },
        swiftprox_moving_compound = CMovingCompound { compound, motion },
        swiftprox_compound_cast_answer = CompoundCastAnswer { answer, piece1, piece2 },
        swiftprox_compound_ray_answer = CompoundRayAnswer { answer, piece },
        swiftprox_compound_point_answer = CompoundPointAnswer { answer, piece },
        swiftprox_draw = CDraw { struct_size, kinds, normal_length, user, line, point, text },
        swiftprox_replay_step_info = CReplayStep {
            struct_size, has_step, has_query, kind, cut_off, fraction
        },
        swiftprox_shape_tuning = CShapeTuning {
            struct_size, hierarchy, lookup, decimation, minimum_triangles, most_levels,
            lookup_radius_factor, lookup_resolution
        },
        swiftprox_shape_tuning_info = TuningInfo {
            struct_size, hierarchy, lookup, level_count, level_bytes, lookup_bytes, lookup_resolution
        },
        swiftprox_level_info = LevelInfo {
            struct_size, vertex_count, edge_count, face_count, triangle_count, deviation, bytes
        },
        swiftprox_pair_tuning = CPairTuning { struct_size, start, levels, refinement },
    };
    // Its only member is private, and so as large as it and at its beginning.
    let (size, alignment) = (size_of::<ObjectId>(), align_of::<ObjectId>());
    let id = Layout { name: "swiftprox_object_id", size, alignment, members: vec![("bits", 0, size)] };
    let behind = all.iter().position(|layout| layout.name == "swiftprox_object_options").unwrap();
    all.insert(behind, id);
    all
}

/// The structs of the headers, each with its members, in order.
fn declared() -> Vec<(String, Vec<String>)> {
    let mut structs = Vec::new();
    let mut is_open = false;
    for line in headers().concat().lines().filter(|line| !line.trim_start().starts_with(['/', '*'])) {
        if let Some(name) = line.strip_prefix("typedef struct ").and_then(|rest| rest.strip_suffix(" {")) {
            structs.push((name.to_string(), Vec::new()));
            is_open = true;
        } else if line.starts_with('}') {
            is_open = false;
        } else if let (true, Some(declaration)) = (is_open, line.strip_suffix(';')) {
            // A pointer to a function has its name in parentheses, an array its length behind it.
            let before = declaration.split_once("(*").map_or(declaration, |(_, name)| name.split(')').next().unwrap());
            let name = before.split([' ', '*']).next_back().unwrap().split('[').next().unwrap();
            structs.last_mut().unwrap().1.push(name.to_string());
        }
    }
    structs
}

#[test]
fn every_member_of_the_headers_is_listed_here() {
    let listed: Vec<(String, Vec<String>)> = layouts()
        .into_iter()
        .map(|layout| (layout.name.to_string(), layout.members.iter().map(|(name, ..)| name.to_string()).collect()))
        .collect();
    assert_eq!(listed, declared(), "tests/project/layout.rs lists what the headers declare");
}

#[test]
#[cfg_attr(not(target_pointer_width = "64"), ignore = "the table is that of 64 bits")]
fn rust_lays_structs_out_as_the_table_says() {
    let mut table = HEAD.to_string();
    for layout in layouts() {
        writeln!(table, "\nSTRUCT({}, {}, {})", layout.name, layout.size, layout.alignment).unwrap();
        for (member, offset, size) in layout.members {
            writeln!(table, "MEMBER({}, {member}, {offset}, {size})", layout.name).unwrap();
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(TABLE);
    if std::env::var_os("BLESS").is_some() {
        fs::write(&path, &table).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    let different = table.lines().zip(committed.lines()).find(|(new, old)| new != old);
    assert!(
        table == committed,
        "the layout is not that of {TABLE} (first difference: {different:?}); BLESS=1 cargo test --test project layout"
    );
}

/// The name of a struct, and what is in memory of each member.
#[allow(unsafe_code, reason = "bytes of a struct as C sees them")]
fn bytes_of<T>(name: &'static str, value: T) -> (&'static str, Vec<Vec<u8>>) {
    let layout = layouts().into_iter().find(|layout| layout.name == name).expect("each struct is listed");
    let start = (&raw const value).cast::<u8>();
    let bytes = |(_, offset, size): &(_, usize, usize)| {
        // SAFETY: members are numbers, pointers and arrays of them, within the struct, and are initialised.
        unsafe { std::slice::from_raw_parts(start.add(*offset), *size) }.to_vec()
    };
    (name, layout.members.iter().map(bytes).collect())
}

/// What C begins a struct with is what the library takes for null. Only members are compared: between them is nothing.
#[test]
#[cfg_attr(not(target_pointer_width = "64"), ignore = "the table is that of 64 bits")]
fn constants_of_c_are_the_defaults_of_rust() {
    let defaults = [
        bytes_of("swiftprox_shape_options", CShapeOptions::DEFAULT),
        bytes_of("swiftprox_pair_config", CPairConfig::DEFAULT),
        bytes_of("swiftprox_depth_config", CDepthConfig::DEFAULT),
        bytes_of("swiftprox_manifold_config", CManifoldConfig::DEFAULT),
        bytes_of("swiftprox_scene_options", CSceneOptions::DEFAULT),
        bytes_of("swiftprox_object_options", CObjectOptions::DEFAULT),
        bytes_of("swiftprox_scene_query", CSceneQuery::DEFAULT),
        bytes_of("swiftprox_cast_config", CCastConfig::defaults()),
        bytes_of("swiftprox_clearance_config", CClearanceConfig::defaults()),
        bytes_of("swiftprox_scene_ground_config", CSceneGroundConfig::DEFAULT),
        bytes_of("swiftprox_draw", CDraw::DEFAULT),
        bytes_of("swiftprox_shape_tuning", CShapeTuning::DEFAULT),
        bytes_of("swiftprox_pair_tuning", CPairTuning::DEFAULT),
    ];
    let constants =
        headers().concat().lines().filter(|line| line.starts_with("#define ") && line.contains("_DEFAULT ")).count();
    assert_eq!(constants, defaults.len(), "each constant is compared");
    let printed = constants_of_c(&defaults.iter().map(|(name, _)| *name).collect::<Vec<_>>());
    let layouts = layouts();
    for ((name, ours), theirs) in defaults.iter().zip(printed.lines()) {
        let theirs: Vec<u8> = theirs.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect();
        let layout = layouts.iter().find(|layout| layout.name == *name).expect("each struct is listed");
        assert_eq!((layout.size, layout.members.len()), (theirs.len(), ours.len()), "{name}");
        for ((member, offset, size), ours) in layout.members.iter().zip(ours) {
            assert_eq!(ours[..], theirs[*offset..offset + size], "{name}.{member}");
        }
    }
}

/// What a C program prints of its constants, a line for each.
fn constants_of_c(names: &[&str]) -> String {
    let mut source = "#include <stdio.h>\n#include <string.h>\n".to_string();
    for header in ["draw", "ground", "motion", "tuning"] {
        writeln!(source, "#include \"swiftprox/{header}.h\"").unwrap();
    }
    source += "int main(void)\n{\n    unsigned char bytes[4096];\n    size_t i;\n";
    for name in names {
        let constant = format!("{}_DEFAULT", name.to_uppercase());
        writeln!(source, "    {{\n        {name} value = {constant};\n        memcpy(bytes, &value, sizeof value);")
            .unwrap();
        source +=
            "        for (i = 0; i < sizeof value; ++i) printf(\"%02x \", bytes[i]);\n        puts(\"\");\n    }\n";
    }
    source += "    return 0;\n}\n";
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let (unit, program) = (folder.join("constants.c"), folder.join("constants"));
    fs::write(&unit, source).unwrap();
    let include = Path::new(env!("CARGO_MANIFEST_DIR")).join("include");
    let compiled = Command::new("cc").arg("-I").arg(include).arg(&unit).arg("-o").arg(&program).output();
    let compiled = compiled.expect("a C compiler is installed");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    String::from_utf8(Command::new(program).output().unwrap().stdout).unwrap()
}
