/* SWIFT_Scene: adding, copying and deleting objects. A part of SWIFT.h, which includes it at its end. */
#ifndef SWIFT_LEGACY_SCENE_ADDING_H
#define SWIFT_LEGACY_SCENE_ADDING_H

inline SWIFT_Scene::SWIFT_Scene(bool broad_phase, bool)
    : scene_(NULL), gives_pairs_(false), has_broad_phase_(broad_phase), convexity_(swift_legacy::CONVEXITY_REQUIRED)
{
    if (swiftprox_library_check_version(SWIFTPROX_VERSION_MAJOR, SWIFTPROX_VERSION_MINOR, SWIFTPROX_VERSION_PATCH) != SWIFTPROX_OK) {
        swift_legacy::report_failure("Error (SWIFT_Scene): ");
    }
    check(swiftprox_scene_create(NULL, &scene_), "SWIFT_Scene");
    const swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query_ = query;
}

inline SWIFT_Scene::~SWIFT_Scene()
{
    check(swiftprox_scene_destroy(scene_), "~SWIFT_Scene");
}

inline void SWIFT_Scene::check(swiftprox_status status, const char* method) const
{
    if (status != SWIFTPROX_OK) {
        swift_legacy::report_failure_of(method);
    }
}

inline bool SWIFT_Scene::has_object(int id, const char* method) const
{
    const bool has = objects_.has(id);
    if (!has) {
        swift_legacy::report_no_object(id, method);
    }
    return has;
}

/* Hands the parts over to the scene. Several pieces of one part are a compound: pairs of objects have one answer, by its tree. */
inline bool SWIFT_Scene::insert(const char* method, std::vector<swift_legacy::Part>& parts, bool fixed, int& id)
{
    std::vector<const swiftprox_shape*> shapes;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        for (std::size_t piece = 0; piece < parts[i].pieces.size(); ++piece) {
            shapes.push_back(parts[i].pieces[piece]->shape);
        }
    }
    objects_.reserve();
    const int next = objects_.next_id();
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    options.fixed = fixed ? 1 : 0;
    options.user_data = static_cast<uint64_t>(next);
    swiftprox_object_id native;
    swiftprox_status status = SWIFTPROX_OK;
    if (shapes.size() > parts.size()) {
        status = swiftprox_compound_create(&shapes[0], NULL, shapes.size(), &options.compound);
        shapes.clear();
    }
    if (status == SWIFTPROX_OK) {
        status = swiftprox_scene_add_object(scene_, shapes.empty() ? NULL : &shapes[0], shapes.size(), &options, &native);
        swiftprox_compound_release(options.compound);
    }
    if (status != SWIFTPROX_OK) {
        swift_legacy::report_failure(swift_legacy::about_piece(method, next, 0));
        return false;
    }
    objects_.add(native, fixed, parts);
    id = next;
    return true;
}

inline bool SWIFT_Scene::add_one(const swift_legacy::LevelArrays& levels, const swift_legacy::CopySource& source,
                                 const swift_legacy::PartSettings& settings, const swift_legacy::Adder& adder, bool fixed, int& id)
{
    const swift_legacy::PartBuilder builder(objects_, fixed, convexity_, adder);
    std::vector<swift_legacy::Part> parts(1);
    return builder.build(0, levels, source, settings, parts[0]) && insert(adder.method, parts, fixed, id);
}

inline bool SWIFT_Scene::add_pieces(const std::vector<swift_legacy::LevelArrays>& pieces, const swift_legacy::PieceArrays& arrays,
                                    bool fixed, int& id)
{
    const swift_legacy::Adder adder("Add_Object", swift_legacy::SAYS_CREATION_FAILED, swift_legacy::BOX_ABOUT_CENTROID);
    if (pieces.empty()) {
        swift_legacy::report(swift_legacy::about_piece(adder.method, objects_.next_id(), 0) + "the number of pieces is not positive");
        return false;
    }
    const swift_legacy::PartBuilder builder(objects_, fixed, convexity_, adder);
    std::vector<swift_legacy::Part> parts(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const int piece = static_cast<int>(i);
        if (!builder.build(piece, pieces[i], arrays.source(piece), arrays.settings(piece), parts[i])) {
            return false;
        }
        if (parts[i].pieces.size() > 1 && parts.size() > 1) {
            swift_legacy::report(swift_legacy::about_piece(adder.method, objects_.next_id(), piece) +
                                 "a piece cannot be a copy of a decomposed object, unless it is the only one");
            return false;
        }
    }
    return insert(adder.method, parts, fixed, id);
}

inline bool SWIFT_Scene::Add_Object(const SWIFT_Real* vertices, const int* faces, int num_vertices, int num_faces, int& id,
                                    bool fixed, const SWIFT_Orientation& orient, const SWIFT_Translation& trans, SWIFT_Real scale,
                                    int box_setting, SWIFT_Real box_enl_rel, SWIFT_Real box_enl_abs, const int* face_valences,
                                    int copy_oid, int copy_pid, int min_tri_count, SWIFT_Real qslim_tri_ratio, SWIFT_Real)
{
    swift_legacy::LevelArrays levels(&orient, &trans, &scale, 1);
    levels.from_arrays(&vertices, &faces, &num_vertices, &num_faces, &face_valences);
    const swift_legacy::PartSettings settings(box_setting, box_enl_rel, box_enl_abs,
                                              swift_legacy::LevelOptions(min_tri_count, qslim_tri_ratio));
    return add_one(levels, swift_legacy::CopySource(copy_oid, copy_pid), settings,
                   swift_legacy::Adder("Add_Object", swift_legacy::SAYS_WHY, swift_legacy::BOX_ABOUT_CENTROID), fixed, id);
}

inline bool SWIFT_Scene::Add_Object(const char* filename, int& id, bool fixed, const SWIFT_Orientation& orient,
                                    const SWIFT_Translation& trans, SWIFT_Real scale, int box_setting, SWIFT_Real box_enl_rel,
                                    SWIFT_Real box_enl_abs, int min_tri_count, SWIFT_Real qslim_tri_ratio, SWIFT_Real)
{
    swift_legacy::LevelArrays levels(&orient, &trans, &scale, 1);
    levels.filenames = &filename;
    const swift_legacy::PartSettings settings(box_setting, box_enl_rel, box_enl_abs,
                                              swift_legacy::LevelOptions(min_tri_count, qslim_tri_ratio));
    return add_one(levels, swift_legacy::CopySource(-1, -1), settings,
                   swift_legacy::Adder("Add_Object", swift_legacy::SAYS_CREATION_FAILED, swift_legacy::BOX_ABOUT_CENTROID), fixed, id);
}

inline bool SWIFT_Scene::Add_Convex_Object(const SWIFT_Real* vertices, const int* faces, int num_vertices, int num_faces, int& id,
                                           bool fixed, const SWIFT_Orientation& orient, const SWIFT_Translation& trans,
                                           SWIFT_Real scale, int box_setting, SWIFT_Real box_enl_rel, SWIFT_Real box_enl_abs,
                                           const int* face_valences, SWIFT_Real)
{
    swift_legacy::LevelArrays levels(&orient, &trans, &scale, 1);
    levels.from_arrays(&vertices, &faces, &num_vertices, &num_faces, &face_valences);
    const swift_legacy::PartSettings settings(box_setting, box_enl_rel, box_enl_abs,
                                              swift_legacy::LevelOptions(DEFAULT_MIN_TCOUNT, DEFAULT_QSLIM_TRATIO));
    return add_one(levels, swift_legacy::CopySource(-1, -1), settings,
                   swift_legacy::Adder("Add_Convex_Object", swift_legacy::SAYS_WHY, swift_legacy::BOX_ABOUT_ORIGIN), fixed, id);
}

inline bool SWIFT_Scene::Add_General_Object(const char* filename, int& id, bool fixed, const SWIFT_Orientation& orient,
                                            const SWIFT_Translation& trans, SWIFT_Real scale, SPLIT_TYPE, int box_setting,
                                            SWIFT_Real box_enl_rel, SWIFT_Real box_enl_abs, SWIFT_Real)
{
    swift_legacy::Adder adder("Add_General_Object", swift_legacy::SAYS_CREATION_FAILED, swift_legacy::BOX_ABOUT_ORIGIN);
    adder.decomposes = true;
    const swift_legacy::PartSettings settings(box_setting, box_enl_rel, box_enl_abs,
                                              swift_legacy::LevelOptions(DEFAULT_MIN_TCOUNT, DEFAULT_QSLIM_TRATIO));
    std::vector<swift_legacy::Mesh> pieces;
    const swift_legacy::PieceFileResult kind = swift_legacy::pieces_from_file(filename, pieces);
    if (kind == swift_legacy::PIECE_FILE_REFUSED) {
        return false;
    }
    if (kind == swift_legacy::PIECE_FILE_NONE) {
        swift_legacy::LevelArrays levels(&orient, &trans, &scale, 1);
        levels.filenames = &filename;
        return add_one(levels, swift_legacy::CopySource(-1, -1), settings, adder, fixed, id);
    }
    const swift_legacy::Transform transform(orient, trans, scale);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        swift_legacy::find_tolerance(pieces[i]);
        pieces[i].transform(transform);
    }
    const swift_legacy::PartBuilder builder(objects_, fixed, convexity_, adder);
    std::vector<swift_legacy::Part> parts(1);
    return builder.from_decomposition(pieces, swift_legacy::CONVEXITY_BY_HULL, settings, parts[0]) && insert(adder.method, parts, fixed, id);
}

inline bool SWIFT_Scene::Add_Pieced_Object(const SWIFT_Real* const* vertices, const int* const* faces, const int* num_vertices,
                                           const int* num_faces, int num_pieces, int& id, bool fixed,
                                           const SWIFT_Orientation* orient, const SWIFT_Translation* trans,
                                           const SWIFT_Real* scales, const int* box_settings, const SWIFT_Real* box_enl_rel,
                                           const SWIFT_Real* box_enl_abs, const int* const* face_valences, const int* copy_oids,
                                           const int* copy_pids, const int* min_tri_count, const SWIFT_Real* qslim_tri_ratio,
                                           const SWIFT_Real*)
{
    std::vector<swift_legacy::LevelArrays> pieces;
    for (int i = 0; i < num_pieces; ++i) {
        swift_legacy::LevelArrays levels(swift_legacy::from(orient, i), swift_legacy::from(trans, i), swift_legacy::from(scales, i),
                                         1);
        levels.from_arrays(swift_legacy::from(vertices, i), swift_legacy::from(faces, i), swift_legacy::from(num_vertices, i),
                           swift_legacy::from(num_faces, i), swift_legacy::from(face_valences, i));
        pieces.push_back(levels);
    }
    const swift_legacy::PieceArrays arrays = {box_settings, box_enl_rel,   box_enl_abs,    copy_oids,
                                              copy_pids,    min_tri_count, qslim_tri_ratio};
    return add_pieces(pieces, arrays, fixed, id);
}

inline bool SWIFT_Scene::Add_Pieced_Object(const char* const* filenames, int num_pieces, int& id, bool fixed,
                                           const SWIFT_Orientation* orient, const SWIFT_Translation* trans,
                                           const SWIFT_Real* scales, const int* box_settings, const SWIFT_Real* box_enl_rel,
                                           const SWIFT_Real* box_enl_abs, const int* copy_oids, const int* copy_pids,
                                           const int* min_tri_count, const SWIFT_Real* qslim_tri_ratio, const SWIFT_Real*)
{
    const char* const none = NULL;
    std::vector<swift_legacy::LevelArrays> pieces;
    for (int i = 0; i < num_pieces; ++i) {
        swift_legacy::LevelArrays levels(swift_legacy::from(orient, i), swift_legacy::from(trans, i), swift_legacy::from(scales, i),
                                         1);
        levels.filenames = filenames == NULL ? &none : filenames + i;
        pieces.push_back(levels);
    }
    const swift_legacy::PieceArrays arrays = {box_settings, box_enl_rel,   box_enl_abs,    copy_oids,
                                              copy_pids,    min_tri_count, qslim_tri_ratio};
    return add_pieces(pieces, arrays, fixed, id);
}

inline bool SWIFT_Scene::Add_Hierarchical_Object(const SWIFT_Real* const* vertices, const int* const* faces,
                                                 const int* num_vertices, const int* num_faces, int num_levels, int& id, bool fixed,
                                                 const SWIFT_Orientation* orient, const SWIFT_Translation* trans,
                                                 const SWIFT_Real* scale, int box_setting, SWIFT_Real box_enl_rel,
                                                 SWIFT_Real box_enl_abs, const int* const* face_valences, SWIFT_Real)
{
    swift_legacy::LevelArrays levels(orient, trans, scale, num_levels);
    levels.from_arrays(vertices, faces, num_vertices, num_faces, face_valences);
    const swift_legacy::PartSettings settings(box_setting, box_enl_rel, box_enl_abs,
                                              swift_legacy::LevelOptions(DEFAULT_MIN_TCOUNT, DEFAULT_QSLIM_TRATIO));
    return add_one(levels, swift_legacy::CopySource(-1, -1), settings,
                   swift_legacy::Adder("Add_Object", swift_legacy::SAYS_CREATION_FAILED, swift_legacy::BOX_ABOUT_CENTROID), fixed, id);
}

inline bool SWIFT_Scene::Add_Hierarchical_Object(const char* const* filenames, int num_levels, int& id, bool fixed,
                                                 const SWIFT_Orientation* orient, const SWIFT_Translation* trans,
                                                 const SWIFT_Real* scale, int box_setting, SWIFT_Real box_enl_rel,
                                                 SWIFT_Real box_enl_abs, SWIFT_Real)
{
    const char* const none = NULL;
    swift_legacy::LevelArrays levels(orient, trans, scale, filenames == NULL ? 1 : num_levels);
    levels.filenames = filenames == NULL ? &none : filenames;
    const swift_legacy::PartSettings settings(box_setting, box_enl_rel, box_enl_abs,
                                              swift_legacy::LevelOptions(DEFAULT_MIN_TCOUNT, DEFAULT_QSLIM_TRATIO));
    return add_one(levels, swift_legacy::CopySource(-1, -1), settings,
                   swift_legacy::Adder("Add_Object", swift_legacy::SAYS_CREATION_FAILED, swift_legacy::BOX_ABOUT_CENTROID), fixed, id);
}

inline bool SWIFT_Scene::Add_Hierarchical_Pieced_Object(
    const SWIFT_Real* const* const* vertices, const int* const* const* faces, const int* const* num_vertices,
    const int* const* num_faces, const int* num_levels, int num_pieces, int& id, bool fixed,
    const SWIFT_Orientation* const* orient, const SWIFT_Translation* const* trans, const SWIFT_Real* const* scales,
    const int* box_settings, const SWIFT_Real* box_enl_rel, const SWIFT_Real* box_enl_abs, const int* const* const* face_valences,
    const int* copy_oids, const int* copy_pids, const int* min_tri_count, const SWIFT_Real* qslim_tri_ratio, const SWIFT_Real*)
{
    std::vector<swift_legacy::LevelArrays> pieces;
    for (int i = 0; i < num_pieces; ++i) {
        swift_legacy::LevelArrays levels(swift_legacy::at(orient, i), swift_legacy::at(trans, i), swift_legacy::at(scales, i),
                                         swift_legacy::level_count(num_levels, i));
        levels.from_arrays(swift_legacy::at(vertices, i), swift_legacy::at(faces, i), swift_legacy::at(num_vertices, i),
                           swift_legacy::at(num_faces, i), swift_legacy::at(face_valences, i));
        pieces.push_back(levels);
    }
    const swift_legacy::PieceArrays arrays = {box_settings, box_enl_rel,   box_enl_abs,    copy_oids,
                                              copy_pids,    min_tri_count, qslim_tri_ratio};
    return add_pieces(pieces, arrays, fixed, id);
}

inline bool SWIFT_Scene::Add_Hierarchical_Pieced_Object(
    const char* const* const* filenames, const int* num_levels, int num_pieces, int& id, bool fixed,
    const SWIFT_Orientation* const* orient, const SWIFT_Translation* const* trans, const SWIFT_Real* const* scales,
    const int* box_settings, const SWIFT_Real* box_enl_rel, const SWIFT_Real* box_enl_abs, const int* copy_oids,
    const int* copy_pids, const int* min_tri_count, const SWIFT_Real* qslim_tri_ratio, const SWIFT_Real*)
{
    const char* const none = NULL;
    std::vector<swift_legacy::LevelArrays> pieces;
    for (int i = 0; i < num_pieces; ++i) {
        const char* const* names = swift_legacy::at(filenames, i);
        swift_legacy::LevelArrays levels(swift_legacy::at(orient, i), swift_legacy::at(trans, i), swift_legacy::at(scales, i),
                                         names == NULL ? 1 : swift_legacy::level_count(num_levels, i));
        levels.filenames = names == NULL ? &none : names;
        pieces.push_back(levels);
    }
    const swift_legacy::PieceArrays arrays = {box_settings, box_enl_rel,   box_enl_abs,    copy_oids,
                                              copy_pids,    min_tri_count, qslim_tri_ratio};
    return add_pieces(pieces, arrays, fixed, id);
}

inline bool SWIFT_Scene::Copy_Object(int copy_oid, int& id)
{
    if (!has_object(copy_oid, "Copy_Object")) {
        return false;
    }
    objects_.reserve();
    std::vector<swift_legacy::Part> parts = objects_[copy_oid].parts;
    const int next = objects_.next_id();
    swiftprox_object_id native;
    if (swiftprox_scene_copy_object(scene_, objects_[copy_oid].native, &native) != SWIFTPROX_OK) {
        swift_legacy::report_failure("Error (Copy_Object): ");
        return false;
    }
    swiftprox_object_info info;
    info.struct_size = sizeof info;
    check(swiftprox_scene_get_object_info(scene_, native, &info), "Copy_Object");
    info.user_data = static_cast<uint64_t>(next);
    check(swiftprox_scene_set_object_info(scene_, native, &info), "Copy_Object");
    objects_.add(native, objects_[copy_oid].is_fixed, parts);
    id = next;
    return true;
}

inline bool SWIFT_Scene::Delete_Object(int id)
{
    if (!has_object(id, "Delete_Object")) {
        return false;
    }
    check(swiftprox_scene_remove_object(scene_, objects_[id].native), "Delete_Object");
    objects_.remove(id);
    return true;
}

inline void SWIFT_Scene::Get_Center_Of_Mass(int id, SWIFT_Real& x, SWIFT_Real& y, SWIFT_Real& z)
{
    x = y = z = 0;
    if (!has_object(id, "Get_Center_Of_Mass")) {
        return;
    }
    swift_legacy::SurfaceCentroid centroid;
    const std::vector<swift_legacy::Part>& parts = objects_[id].parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        for (std::size_t piece = 0; piece < parts[i].pieces.size(); ++piece) {
            centroid.add(parts[i].pieces[piece]->body());
        }
    }
    x = static_cast<SWIFT_Real>(centroid[0]);
    y = static_cast<SWIFT_Real>(centroid[1]);
    z = static_cast<SWIFT_Real>(centroid[2]);
}

inline bool SWIFT_Scene::Register_File_Reader(const char* magic_number, SWIFT_File_Reader* file_reader) const
{
    return get_File_Read_Dispatcher()->Register(magic_number, file_reader);
}

inline SWIFT_File_Read_Dispatcher* SWIFT_Scene::get_File_Read_Dispatcher() const
{
    return &swift_legacy::file_dispatcher();
}

inline void SWIFT_Scene::Set_Take_Hull(bool take_hull)
{
    convexity_ = take_hull ? swift_legacy::CONVEXITY_BY_HULL : swift_legacy::CONVEXITY_REQUIRED;
}

inline swiftprox_scene* SWIFT_Scene::Get_Native_Scene() const
{
    return scene_;
}

inline swiftprox_object_id SWIFT_Scene::Get_Native_Object(int id) const
{
    return objects_.has(id) ? objects_[id].native : swiftprox_object_id();
}

#endif
