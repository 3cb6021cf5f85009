/* SWIFT_Scene: transformations, which pairs are tested, and queries. A part of SWIFT.h, which includes it at its end. */
#ifndef SWIFT_LEGACY_SCENE_QUERIES_H
#define SWIFT_LEGACY_SCENE_QUERIES_H

inline void SWIFT_Scene::Set_Object_Transformation(int id, const SWIFT_Real* R, const SWIFT_Real* T)
{
    swift_legacy::Object* object = objects_.find(id);
    if (object == NULL) {
        swift_legacy::report_no_object(id, "Set_Object_Transformation(id)");
        return;
    }
    object->has_boxes = false;
    check(swift_legacy::set_transform(scene_, object->native, R, T), "Set_Object_Transformation");
}

inline void SWIFT_Scene::Set_Object_Transformation(int id, const SWIFT_Real* RT)
{
    swift_legacy::Object* object = objects_.find(id);
    if (object == NULL) {
        swift_legacy::report_no_object(id, "Set_Object_Transformation(id)");
        return;
    }
    object->has_boxes = false;
    check(swift_legacy::set_pose(scene_, object->native, RT), "Set_Object_Transformation");
}

inline void SWIFT_Scene::Set_All_Object_Transformations(const SWIFT_Real* R, const SWIFT_Real* T)
{
    if (objects_.moving_count() > 0) {
        objects_.forget_boxes();
        check(swift_legacy::set_all_transforms(scene_, R, T, objects_.moving_count()), "Set_All_Object_Transformations");
    }
}

inline void SWIFT_Scene::Set_All_Object_Transformations(const SWIFT_Real* RT)
{
    if (objects_.moving_count() > 0) {
        objects_.forget_boxes();
        check(swift_legacy::set_all_poses(scene_, RT, objects_.moving_count()), "Set_All_Object_Transformations");
    }
}

/* Whether two ids name a pair. */
inline bool SWIFT_Scene::has_pair(int id1, int id2, const char* method) const
{
    if (!has_object(id1, method) || !has_object(id2, method)) {
        return false;
    }
    if (id1 == id2) {
        swift_legacy::warn("Warning: object ids equal given to " + std::string(method) + ": No effect");
    }
    return id1 != id2;
}

inline void SWIFT_Scene::Activate(int id1, int id2)
{
    if (has_pair(id1, id2, "Activate(id1,id2)")) {
        check(swiftprox_scene_set_pair_active(scene_, &objects_[id1].native, &objects_[id2].native, 1), "Activate");
    }
}

inline void SWIFT_Scene::Activate(int id)
{
    if (has_object(id, "Activate(id)")) {
        check(swiftprox_scene_set_pair_active(scene_, &objects_[id].native, NULL, 1), "Activate");
    }
}

inline void SWIFT_Scene::Activate()
{
    check(swiftprox_scene_set_pair_active(scene_, NULL, NULL, 1), "Activate");
}

inline void SWIFT_Scene::Deactivate(int id1, int id2)
{
    if (has_pair(id1, id2, "Deactivate(id1,id2)")) {
        check(swiftprox_scene_set_pair_active(scene_, &objects_[id1].native, &objects_[id2].native, 0), "Deactivate");
    }
}

inline void SWIFT_Scene::Deactivate(int id)
{
    if (has_object(id, "Deactivate(id)")) {
        check(swiftprox_scene_set_pair_active(scene_, &objects_[id].native, NULL, 0), "Deactivate");
    }
}

inline void SWIFT_Scene::Deactivate()
{
    check(swiftprox_scene_set_pair_active(scene_, NULL, NULL, 0), "Deactivate");
}

/* Has the scene test the pairs of objects whose boxes overlap. */
inline void SWIFT_Scene::give_overlapping_boxes()
{
    const std::vector<int>& created = objects_.created();
    for (std::size_t i = 0; i < created.size(); ++i) {
        swift_legacy::Object& object = objects_[created[i]];
        if (!object.has_boxes) {
            swiftprox_object_info info;
            info.struct_size = sizeof info;
            check(swiftprox_scene_get_object_info(scene_, object.native, &info), "Query");
            object.place_boxes(info.pose);
        }
    }
    if (box_pairs_.find(objects_) || !gives_pairs_) {
        const std::vector<swiftprox_object_id>& pairs = box_pairs_.pairs();
        const swiftprox_status status = swiftprox_scene_set_pairs(scene_, pairs.empty() ? NULL : &pairs[0], pairs.size() / 2);
        check(status, "Query");
        gives_pairs_ = status == SWIFTPROX_OK;
    }
}

/* Has the scene find near pairs itself. */
inline void SWIFT_Scene::take_near_pairs()
{
    if (gives_pairs_) {
        const swiftprox_status status = swiftprox_scene_reset_pairs(scene_);
        check(status, "Query");
        gives_pairs_ = status != SWIFTPROX_OK;
    }
}

/* Drops the pairs whose boxes do not overlap; those that intersect stay. */
inline void SWIFT_Scene::keep_overlapping_boxes()
{
    std::vector<swift_legacy::Entry>& listed = results_.listed();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < listed.size(); ++i) {
        const swift_legacy::Found& found = *listed[i].found;
        const swift_legacy::Part& part1 = part(found.user_data1, found.piece1);
        const swift_legacy::Part& part2 = part(found.user_data2, found.piece2);
        if (swift_legacy::is_intersecting(found) || swift_legacy::overlap(part1.world_box, part2.world_box)) {
            listed[kept++] = listed[i];
        }
    }
    listed.resize(kept);
}

/* The part of a piece. */
inline const swift_legacy::Part& SWIFT_Scene::part(uint64_t id, uint32_t piece) const
{
    const swift_legacy::Object& object = objects_[static_cast<int>(id)];
    return object.parts[static_cast<std::size_t>(object.part_of(piece))];
}

/* Asks, and lists what is found; true if a tested pair intersects. After a failure nothing is listed. */
inline bool SWIFT_Scene::ask(const swift_legacy::Question& question, int& num_pairs, int** oids)
{
    query_.early_exit = question.early_exit ? 1 : 0;
    query_.max_distance = question.tolerance;
    query_.absolute_error = question.absolute_error;
    query_.relative_error = question.relative_error;
#ifdef SWIFT_LEGACY_ALL_PAIRS
    const bool lists_by_boxes = false;
#else
    const bool lists_by_boxes = has_broad_phase_ && question.tolerance > DBL_MAX;
#endif
    if (lists_by_boxes) {
        give_overlapping_boxes();
    } else {
        take_near_pairs();
    }
    swiftprox_scene_answer answer;
    answer.pairs = NULL;
    answer.count = 0;
    answer.intersecting = 0;
    answer.found = NULL;
    check(question.ask(scene_, &query_, &answer), "Query");
    objects_.rank();
    results_.take(answer, objects_);
    if (lists_by_boxes) {
        keep_overlapping_boxes();
    }
    num_pairs = results_.count();
    if (oids != NULL) {
        *oids = results_.write_ids();
    }
    return answer.intersecting != 0;
}

inline bool SWIFT_Scene::Query_Intersection(bool early_exit, int& num_pairs, int** oids)
{
    const swift_legacy::Question question(swiftprox_scene_query_intersection, early_exit, 0);
    const bool intersects = ask(question, num_pairs, oids);
    return intersects;
}

inline bool SWIFT_Scene::Query_Tolerance_Verification(bool early_exit, SWIFT_Real tolerance, int& num_pairs, int** oids)
{
    /* It ends early at pairs that are near, too: swiftprox looks at all of them. */
    const swift_legacy::Question question(swiftprox_scene_query_distance, false,
                                          swift_legacy::native_tolerance(tolerance, swift_legacy::BOUND_EXCLUDED));
    ask(question, num_pairs, oids);
    const bool is_any_near = num_pairs > 0;
    if (early_exit) {
        results_.clear();
        num_pairs = 0;
    }
    return is_any_near;
}

inline bool SWIFT_Scene::Query_Exact_Distance(bool early_exit, SWIFT_Real tolerance, int& num_pairs, int** oids,
                                              SWIFT_Real** distances)
{
    const swift_legacy::Bound bound = SWIFT_LEGACY_VERSION == 2 ? swift_legacy::BOUND_EXCLUDED : swift_legacy::BOUND_INCLUDED;
    const swift_legacy::Question question(swiftprox_scene_query_distance, early_exit,
                                          swift_legacy::native_tolerance(tolerance, bound));
    const bool intersects = ask(question, num_pairs, oids);
    if (distances != NULL) {
        *distances = results_.write_distances();
    }
    return intersects;
}

#if SWIFT_LEGACY_VERSION != 2
inline bool SWIFT_Scene::Query_Approximate_Distance(bool early_exit, SWIFT_Real max_distance, SWIFT_Real error_tolerance,
                                                    int& num_pairs, int** oids, SWIFT_Real** distances, SWIFT_Real** errors)
{
    swift_legacy::Question question(swiftprox_scene_query_approximate, early_exit,
                                    swift_legacy::native_tolerance(max_distance, swift_legacy::BOUND_INCLUDED));
    question.absolute_error = swift_legacy::native_error(error_tolerance);
    const bool intersects = ask(question, num_pairs, oids);
    SWIFT_Real* lower_ends = results_.write_lower_ends(errors);
    if (distances != NULL) {
        *distances = lower_ends;
    }
    return intersects;
}

inline bool SWIFT_Scene::Query_Contact_Determination(bool early_exit, SWIFT_Real tolerance, int& num_pairs, int** oids,
                                                     SWIFT_Real** distances, SWIFT_Real** nearest_pts, SWIFT_Real** normals,
                                                     int** pids, int** feature_types, int** feature_ids)
{
    const swift_legacy::Question question(swiftprox_scene_query_contact, early_exit,
                                          swift_legacy::native_tolerance(tolerance, swift_legacy::BOUND_INCLUDED));
    const bool intersects = ask(question, num_pairs, oids);
    if (pids != NULL) {
        *pids = results_.write_parts(objects_);
    }
    write_contacts(swift_legacy::INTERSECTING_TAKE_NEEDED, distances, nearest_pts, normals, feature_types, feature_ids);
    return intersects;
}
#endif

#if SWIFT_LEGACY_VERSION != 1
inline bool SWIFT_Scene::Query_Approximate_Distance(bool early_exit, SWIFT_Real tolerance, SWIFT_Real abs_error,
                                                    SWIFT_Real rel_error, int& num_pairs, int** oids, SWIFT_Real** distances)
{
    swift_legacy::Question question(swiftprox_scene_query_approximate, early_exit,
                                    swift_legacy::native_tolerance(tolerance, swift_legacy::BOUND_EXCLUDED));
    question.absolute_error = swift_legacy::native_error(abs_error);
    question.relative_error = swift_legacy::native_error(rel_error);
    const bool intersects = ask(question, num_pairs, oids);
    if (distances != NULL) {
        *distances = results_.write_distances();
    }
    return intersects;
}

inline bool SWIFT_Scene::Query_Contact_Determination(bool early_exit, SWIFT_Real tolerance, int& num_pairs, int** oids,
                                                     int** num_contacts, SWIFT_Real** distances, SWIFT_Real** nearest_pts,
                                                     SWIFT_Real** normals, int** feature_types, int** feature_ids)
{
    const swift_legacy::Question question(swiftprox_scene_query_contact, early_exit,
                                          swift_legacy::native_tolerance(tolerance, swift_legacy::BOUND_EXCLUDED));
    const bool intersects = ask(question, num_pairs, oids);
    if (num_contacts != NULL) {
        *num_contacts = results_.write_counts();
    }
    write_contacts(swift_legacy::INTERSECTING_TAKE_FOUR, distances, nearest_pts, normals, feature_types, feature_ids);
    return intersects;
}
#endif

inline void SWIFT_Scene::write_contacts(swift_legacy::IntersectingFeatures intersecting, SWIFT_Real** distances,
                                        SWIFT_Real** nearest_pts, SWIFT_Real** normals, int** feature_types, int** feature_ids)
{
    results_.write_contacts(distances, nearest_pts, normals);
    if (feature_types != NULL || feature_ids != NULL) {
        results_.write_features(objects_, intersecting, feature_types, feature_ids);
    }
}

inline const swiftprox_pair_answer* SWIFT_Scene::Get_Answer(int k) const
{
    const swift_legacy::Found* found = results_.found(k);
    return found == NULL ? NULL : &found->answer;
}

inline bool SWIFT_Scene::Get_Depth(int k, swiftprox_depth_answer& depth) const
{
    const swift_legacy::Found* found = results_.found(k);
    if (found == NULL) {
        swift_legacy::report("Error (Get_Depth): the last query has no entry " + swift_legacy::text(k));
        return false;
    }
    const swiftprox_object_id ids[2] = {found->object1, found->object2};
    const uint32_t pieces[2] = {found->piece1, found->piece2};
    swiftprox_object_info infos[2];
    swiftprox_placed objects[2];
    for (int side = 0; side < 2; ++side) {
        infos[side].struct_size = sizeof infos[side];
        if (swiftprox_scene_get_object_info(scene_, ids[side], &infos[side]) != SWIFTPROX_OK) {
            swift_legacy::report_failure_of("Get_Depth");
            return false;
        }
        objects[side].shape = objects_[static_cast<int>(infos[side].user_data)].geometry_of(pieces[side]).shape;
        objects[side].pose = infos[side].pose;
    }
    swiftprox_depth_cache cold;
    std::memset(&cold, 0, sizeof cold);
    const swiftprox_status status = swiftprox_pair_depth(objects[0], objects[1], &cold, NULL, &depth);
    check(status, "Get_Depth");
    return status == SWIFTPROX_OK;
}

#endif
