/* SWIFT_Scene: transformations and which pairs are tested. A part of SWIFT.h, which includes it at its end. */
#ifndef SWIFT_LEGACY_SCENE_PAIRS_H
#define SWIFT_LEGACY_SCENE_PAIRS_H

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

#endif
