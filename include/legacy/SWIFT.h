/*
 * The scene class of SWIFT 1.x and SWIFT++, over swiftprox: old programs compile with this header unchanged and link swiftprox.
 *
 * The methods of both libraries stand side by side. What differs from them, call by call, is in docs/migration.md, and how a new
 * program would say the same. In short: touching is intersecting, -1 is the distance of intersecting pairs, nearest points are
 * in the objects' local frames, which are those after the input transform, and normals in the world, from object 2 to object 1.
 *
 * Arrays that queries hand out belong to the scene and stay until its next query; the program may write into them. Messages go
 * to std::cerr. SWIFT_config.h lists the macros that change something. A scene may be used by one thread at a time; file readers
 * are the whole process's. Arrays that a query was asked for are never null: where nothing is listed they have room for one entry,
 * of zeros, and where an early exit found an intersecting pair that pair stands there.
 */
#ifndef SWIFT_H
#define SWIFT_H

#include "SWIFT_common.h"
#include "SWIFT_config.h"
#include "SWIFT_fileio.h"
#include "swift_legacy/box_pairs.h"
#include "swift_legacy/defaults.h"
#include "swift_legacy/part_builder.h"
#include "swift_legacy/results.h"

class SWIFT_Scene {
public:
    /* `global_sort` changes nothing. What `broad_phase` changes is said at Query_Exact_Distance. */
    SWIFT_Scene(bool broad_phase = DEFAULT_BP, bool global_sort = DEFAULT_GS);
    ~SWIFT_Scene();

    /*
     * Objects. Ids are dense, from 0; a deleted one is given out again, the last first. On failure the result is false, `id` is
     * as it was, and a message says why. The input transform, scale * (orient * v) + trans, is applied once. A mesh is closed and
     * convex up to the precision of its coordinates; two-sided flat polygons are taken. With `copy_oid`, vertices may be NULL and
     * counts 0: the object shares the geometry of that piece, after the transform.
     *
     * That precision is four units of the last place in which coordinates are written (decimals, significant digits, floats), at
     * least 1e-6 of the diagonal and at most 0.005 of it. The convex hull counts, and vertices and faces keep their ids. A vertex
     * that the hull swallows is never reported; a face that it swallows is reported where it is the nearest of those below the
     * hull's face. A mesh whose faces all run clockwise seen from outside is turned. SWIFT_LEGACY_STRICT refuses both.
     */
    bool Add_Object(const SWIFT_Real* vertices, const int* faces, int num_vertices, int num_faces, int& id,
                    bool fixed = DEFAULT_FIXED, const SWIFT_Orientation& orient = DEFAULT_ORIENTATION,
                    const SWIFT_Translation& trans = DEFAULT_TRANSLATION, SWIFT_Real scale = DEFAULT_SCALE,
                    int box_setting = DEFAULT_BOX_SETTING, SWIFT_Real box_enl_rel = DEFAULT_BOX_ENLARGE_REL,
                    SWIFT_Real box_enl_abs = DEFAULT_BOX_ENLARGE_ABS, const int* face_valences = DEFAULT_FACE_VALENCES,
                    int copy_oid = DEFAULT_COPY, int copy_pid = DEFAULT_COPY, int min_tri_count = DEFAULT_MIN_TCOUNT,
                    SWIFT_Real qslim_tri_ratio = DEFAULT_QSLIM_TRATIO, SWIFT_Real cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIO);
    bool Add_Object(const char* filename, int& id, bool fixed = DEFAULT_FIXED,
                    const SWIFT_Orientation& orient = DEFAULT_ORIENTATION, const SWIFT_Translation& trans = DEFAULT_TRANSLATION,
                    SWIFT_Real scale = DEFAULT_SCALE, int box_setting = DEFAULT_BOX_SETTING,
                    SWIFT_Real box_enl_rel = DEFAULT_BOX_ENLARGE_REL, SWIFT_Real box_enl_abs = DEFAULT_BOX_ENLARGE_ABS,
                    int min_tri_count = DEFAULT_MIN_TCOUNT, SWIFT_Real qslim_tri_ratio = DEFAULT_QSLIM_TRATIO,
                    SWIFT_Real cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIO);
    bool Add_Convex_Object(const SWIFT_Real* vertices, const int* faces, int num_vertices, int num_faces, int& id,
                           bool fixed = DEFAULT_FIXED, const SWIFT_Orientation& orient = DEFAULT_ORIENTATION,
                           const SWIFT_Translation& trans = DEFAULT_TRANSLATION, SWIFT_Real scale = DEFAULT_SCALE,
                           int box_setting = DEFAULT_BOX_SETTING, SWIFT_Real box_enl_rel = DEFAULT_BOX_ENLARGE_REL,
                           SWIFT_Real box_enl_abs = DEFAULT_BOX_ENLARGE_ABS, const int* face_valences = DEFAULT_FACE_VALENCES,
                           SWIFT_Real cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIO);

    /*
     * A mesh file, or a decomposition or hierarchy that SWIFT++'s decomposer wrote. A mesh that is not convex, up to the precision
     * of its coordinates, is decomposed: its surface into patches that lie on their hulls, which are the pieces and are inside of
     * the body. It is to be closed, with its faces counter-clockwise seen from outside, or all clockwise. With SWIFT_ALLOW_BOUNDARY
     * an open surface is taken, too, in flat pieces. After Set_Take_Hull(true) the convex hull is taken instead. `split` changes
     * nothing.
     */
    bool Add_General_Object(const char* filename, int& id, bool fixed = DEFAULT_FIXED,
                            const SWIFT_Orientation& orient = DEFAULT_ORIENTATION,
                            const SWIFT_Translation& trans = DEFAULT_TRANSLATION, SWIFT_Real scale = DEFAULT_SCALE,
                            SPLIT_TYPE split = DEFAULT_SPLIT_TYPE, int box_setting = DEFAULT_BOX_SETTING,
                            SWIFT_Real box_enl_rel = DEFAULT_BOX_ENLARGE_REL, SWIFT_Real box_enl_abs = DEFAULT_BOX_ENLARGE_ABS,
                            SWIFT_Real cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIO);

    /*
     * Several convex pieces under one id; queries list pairs of pieces. Arrays that are NULL mean the default for all pieces. A
     * copy of a decomposed object may be the only piece, and no other.
     */
    bool Add_Pieced_Object(const SWIFT_Real* const* vertices, const int* const* faces, const int* num_vertices,
                           const int* num_faces, int num_pieces, int& id, bool fixed = DEFAULT_FIXED,
                           const SWIFT_Orientation* orient = DEFAULT_ORIENTATIONS,
                           const SWIFT_Translation* trans = DEFAULT_TRANSLATIONS, const SWIFT_Real* scales = DEFAULT_SCALES,
                           const int* box_settings = DEFAULT_BOX_SETTINGS, const SWIFT_Real* box_enl_rel = DEFAULT_BOX_ENLARGE_RELS,
                           const SWIFT_Real* box_enl_abs = DEFAULT_BOX_ENLARGE_ABSS,
                           const int* const* face_valences = DEFAULT_FACE_VALENCESS, const int* copy_oids = DEFAULT_COPIES,
                           const int* copy_pids = DEFAULT_COPIES, const int* min_tri_count = DEFAULT_MIN_TCOUNTS,
                           const SWIFT_Real* qslim_tri_ratio = DEFAULT_QSLIM_TRATIOS,
                           const SWIFT_Real* cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIOS);
    bool Add_Pieced_Object(const char* const* filenames, int num_pieces, int& id, bool fixed = DEFAULT_FIXED,
                           const SWIFT_Orientation* orient = DEFAULT_ORIENTATIONS,
                           const SWIFT_Translation* trans = DEFAULT_TRANSLATIONS, const SWIFT_Real* scales = DEFAULT_SCALES,
                           const int* box_settings = DEFAULT_BOX_SETTINGS, const SWIFT_Real* box_enl_rel = DEFAULT_BOX_ENLARGE_RELS,
                           const SWIFT_Real* box_enl_abs = DEFAULT_BOX_ENLARGE_ABSS, const int* copy_oids = DEFAULT_COPIES,
                           const int* copy_pids = DEFAULT_COPIES, const int* min_tri_count = DEFAULT_MIN_TCOUNTS,
                           const SWIFT_Real* qslim_tri_ratio = DEFAULT_QSLIM_TRATIOS,
                           const SWIFT_Real* cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIOS);

    /* One piece with 1 to 32 levels of detail, the finest first, each with an input transform of its own. */
    bool Add_Hierarchical_Object(const SWIFT_Real* const* vertices, const int* const* faces, const int* num_vertices,
                                 const int* num_faces, int num_levels, int& id, bool fixed = DEFAULT_FIXED,
                                 const SWIFT_Orientation* orient = DEFAULT_ORIENTATIONS,
                                 const SWIFT_Translation* trans = DEFAULT_TRANSLATIONS, const SWIFT_Real* scale = DEFAULT_SCALES,
                                 int box_setting = DEFAULT_BOX_SETTING, SWIFT_Real box_enl_rel = DEFAULT_BOX_ENLARGE_REL,
                                 SWIFT_Real box_enl_abs = DEFAULT_BOX_ENLARGE_ABS,
                                 const int* const* face_valences = DEFAULT_FACE_VALENCESS,
                                 SWIFT_Real cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIO);
    bool Add_Hierarchical_Object(const char* const* filenames, int num_levels, int& id, bool fixed = DEFAULT_FIXED,
                                 const SWIFT_Orientation* orient = DEFAULT_ORIENTATIONS,
                                 const SWIFT_Translation* trans = DEFAULT_TRANSLATIONS, const SWIFT_Real* scale = DEFAULT_SCALES,
                                 int box_setting = DEFAULT_BOX_SETTING, SWIFT_Real box_enl_rel = DEFAULT_BOX_ENLARGE_REL,
                                 SWIFT_Real box_enl_abs = DEFAULT_BOX_ENLARGE_ABS,
                                 SWIFT_Real cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIO);

    /* Both: num_levels[i] of 0 means that the one mesh of piece i comes without levels. */
    bool Add_Hierarchical_Pieced_Object(
        const SWIFT_Real* const* const* vertices, const int* const* const* faces, const int* const* num_vertices,
        const int* const* num_faces, const int* num_levels, int num_pieces, int& id, bool fixed = DEFAULT_FIXED,
        const SWIFT_Orientation* const* orient = DEFAULT_ORIENTATIONSS,
        const SWIFT_Translation* const* trans = DEFAULT_TRANSLATIONSS, const SWIFT_Real* const* scales = DEFAULT_SCALESS,
        const int* box_settings = DEFAULT_BOX_SETTINGS, const SWIFT_Real* box_enl_rel = DEFAULT_BOX_ENLARGE_RELS,
        const SWIFT_Real* box_enl_abs = DEFAULT_BOX_ENLARGE_ABSS, const int* const* const* face_valences = DEFAULT_FACE_VALENCESSS,
        const int* copy_oids = DEFAULT_COPIES, const int* copy_pids = DEFAULT_COPIES, const int* min_tri_count = DEFAULT_MIN_TCOUNTS,
        const SWIFT_Real* qslim_tri_ratio = DEFAULT_QSLIM_TRATIOS, const SWIFT_Real* cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIOS);
    bool Add_Hierarchical_Pieced_Object(
        const char* const* const* filenames, const int* num_levels, int num_pieces, int& id, bool fixed = DEFAULT_FIXED,
        const SWIFT_Orientation* const* orient = DEFAULT_ORIENTATIONSS,
        const SWIFT_Translation* const* trans = DEFAULT_TRANSLATIONSS, const SWIFT_Real* const* scales = DEFAULT_SCALESS,
        const int* box_settings = DEFAULT_BOX_SETTINGS, const SWIFT_Real* box_enl_rel = DEFAULT_BOX_ENLARGE_RELS,
        const SWIFT_Real* box_enl_abs = DEFAULT_BOX_ENLARGE_ABSS, const int* copy_oids = DEFAULT_COPIES,
        const int* copy_pids = DEFAULT_COPIES, const int* min_tri_count = DEFAULT_MIN_TCOUNTS,
        const SWIFT_Real* qslim_tri_ratio = DEFAULT_QSLIM_TRATIOS, const SWIFT_Real* cube_aspect_ratio = DEFAULT_CUBE_ASPECT_RATIOS);

    /* The copy has the geometry, the transformation, the fixedness and the boxes of the original; all its pairs are active. */
    bool Copy_Object(int copy_oid, int& id);

    /* False after a message where there is no such object. */
    bool Delete_Object(int id);

    /* The centroid of the surface, after the input transform. Of no object: 0, 0, 0 and a message. */
    void Get_Center_Of_Mass(int id, SWIFT_Real& x, SWIFT_Real& y, SWIFT_Real& z);

    /* For all scenes of the process; see SWIFT_File_Read_Dispatcher::Register. */
    bool Register_File_Reader(const char* magic_number, SWIFT_File_Reader* file_reader) const;
    SWIFT_File_Read_Dispatcher* get_File_Read_Dispatcher() const;

    /*
     * Transformations: row-major, world = R * local + T; RT is the 12 numbers of [R|T]. What is not rigid (an entry of R^T R - 1
     * above 0.01, a reflection) or not finite is refused with a message, and the object stays. Those for all take the objects
     * that are not fixed, in order of creation.
     */
    void Set_Object_Transformation(int id, const SWIFT_Real* R, const SWIFT_Real* T);
    void Set_Object_Transformation(int id, const SWIFT_Real* RT);
    void Set_All_Object_Transformations(const SWIFT_Real* R, const SWIFT_Real* T);
    void Set_All_Object_Transformations(const SWIFT_Real* RT);

    /* Which of the pairs that there are now are tested. Pairs of objects added later are active; two fixed ones make no pair. */
    void Activate(int id1, int id2);
    void Activate(int id);
    void Activate();
    void Deactivate(int id1, int id2);
    void Deactivate(int id);
    void Deactivate();

    /*
     * Queries. The result is true if a tested pair intersects. With `early_exit` a query ends at the first such pair and lists
     * none. Pairs are listed by the object that was created later, then by the other one; in a pair the lower id comes first.
     * Pointers that are NULL ask for nothing.
     *
     * All pairs within the tolerance are listed, whatever the broad phase. Only where it is on and the tolerance is
     * SWIFT_INFINITY, pairs are listed whose enlarged boxes overlap, and those that intersect. Cubes are measured as of old: from
     * the centroid, of objects by Add_Convex_Object and Add_General_Object from the origin of their frame, at least.
     */
    bool Query_Intersection(bool early_exit, int& num_pairs, int** oids);

    /* True if a pair is closer than the tolerance, or intersects. */
    bool Query_Tolerance_Verification(bool early_exit, SWIFT_Real tolerance, int& num_pairs, int** oids);

    /* Distance 1 of pair k is (*distances)[k]; -1 of an intersecting pair. */
    bool Query_Exact_Distance(bool early_exit, SWIFT_Real tolerance, int& num_pairs, int** oids, SWIFT_Real** distances);

#if SWIFT_LEGACY_VERSION != 2
    /* SWIFT 1.x: the distance is at least `distances` and at most `distances + errors`. */
    bool Query_Approximate_Distance(bool early_exit, SWIFT_Real distance_tolerance, SWIFT_Real error_tolerance, int& num_pairs,
                                    int** oids, SWIFT_Real** distances, SWIFT_Real** errors);

    /* SWIFT 1.x: a contact for each pair of pieces, `pids` two for each, like oids. */
    bool Query_Contact_Determination(bool early_exit, SWIFT_Real tolerance, int& num_pairs, int** oids,
                                     SWIFT_Real** distances = NO_DISTANCES, SWIFT_Real** nearest_pts = NO_NEAREST_PTS,
                                     SWIFT_Real** normals = NO_NORMALS, int** pids = NO_PIDS, int** feature_types = NO_FEAT_TYPES,
                                     int** feature_ids = NO_FEAT_IDS);
#endif
#if SWIFT_LEGACY_VERSION != 1
    /* SWIFT++: off by at most abs_error or rel_error times the distance. */
    bool Query_Approximate_Distance(bool early_exit, SWIFT_Real tolerance, SWIFT_Real abs_error, SWIFT_Real rel_error,
                                    int& num_pairs, int** oids, SWIFT_Real** distances);

    /*
     * SWIFT++: `num_contacts` is 1 for each pair, the nearest contact of the two, or -1 for an intersecting pair, which takes one
     * place and four feature ids. SWIFT++ added what it had found on the way to the nearest, in the order of its trees.
     */
    bool Query_Contact_Determination(bool early_exit, SWIFT_Real tolerance, int& num_pairs, int** oids, int** num_contacts,
                                     SWIFT_Real** distances = NO_DISTANCES, SWIFT_Real** nearest_pts = NO_NEAREST_PTS,
                                     SWIFT_Real** normals = NO_NORMALS, int** feature_types = NO_FEAT_TYPES,
                                     int** feature_ids = NO_FEAT_IDS);
#endif

    /* --- Beyond the old libraries -------------------------------------------------------------------------------------------- */

    /*
     * What swiftprox says of entry k of the last query's distances, until the next query: the interval, what decided, the proof;
     * its objects 1 and 2 are in order of creation. NULL where there is no such entry.
     */
    const swiftprox_pair_answer* Get_Answer(int k) const;

    /*
     * How deep the two pieces of entry k are in each other, where their objects are now: the least translation that parts them, in
     * swiftprox's order of the two. False after a message where there is no such entry or an object is gone.
     */
    bool Get_Depth(int k, swiftprox_depth_answer& depth) const;

    /* With true, of a mesh added later that is refused otherwise the convex hull counts; face ids are -1 then. At first false. */
    void Set_Take_Hull(bool take_hull);

    /*
     * The scene, and the name of an object in it (null for no object), for calls of swiftprox that change neither objects nor
     * pairs. A decomposed object of several pieces is a compound there.
     */
    swiftprox_scene* Get_Native_Scene() const;
    swiftprox_object_id Get_Native_Object(int id) const;

private:
    swiftprox_scene* scene_;
    swiftprox_scene_query query_; /* initialised once */
    swift_legacy::Objects objects_;
    swift_legacy::Results results_;
    swift_legacy::BoxPairs box_pairs_;
    bool gives_pairs_; /* the scene tests the box_pairs_, and no others */
    bool has_broad_phase_;
    swift_legacy::Convexity convexity_;

    bool insert(const char* method, std::vector<swift_legacy::Part>& parts, bool fixed, int& id);
    bool add_one(const swift_legacy::LevelArrays& levels, const swift_legacy::CopySource& source,
                 const swift_legacy::PartSettings& settings, const swift_legacy::Adder& adder, bool fixed, int& id);
    bool add_pieces(const std::vector<swift_legacy::LevelArrays>& pieces, const swift_legacy::PieceArrays& arrays, bool fixed,
                    int& id);
    bool has_object(int id, const char* method) const;
    bool has_pair(int id1, int id2, const char* method) const;
    void check(swiftprox_status status, const char* method) const;
    bool ask(const swift_legacy::Question& question, int& num_pairs, int** oids);
    void give_overlapping_boxes();
    void take_near_pairs();
    void keep_overlapping_boxes();
    const swift_legacy::Part& part(uint64_t id, uint32_t piece) const;
    void write_contacts(swift_legacy::IntersectingFeatures intersecting, SWIFT_Real** distances, SWIFT_Real** nearest_pts,
                        SWIFT_Real** normals, int** feature_types, int** feature_ids);

    SWIFT_Scene(const SWIFT_Scene&);
    SWIFT_Scene& operator=(const SWIFT_Scene&);
};

#include "swift_legacy/scene_adding.h"
#include "swift_legacy/scene_queries.h"

/* Last: they break the headers of the standard library. */
#ifdef SWIFT_LEGACY_MIN_MAX
#ifndef min
#define min(a, b) SWIFT_min(a, b)
#endif
#ifndef max
#define max(a, b) SWIFT_max(a, b)
#endif
#endif

#endif
