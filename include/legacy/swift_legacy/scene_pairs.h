/* SWIFT_Scene: transformations and which pairs are tested. */
#ifndef SWIFT_LEGACY_SCENE_PAIRS_H
#define SWIFT_LEGACY_SCENE_PAIRS_H

#include "../SWIFT.h"

/* From R and T, or from [R|T] where T is null. */
inline void SWIFT_Scene::place(int id, const SWIFT_Real* R, const SWIFT_Real* T)
{
    if (!has_object(id, "Set_Object_Transformation(id)")) {
        return;
    }
    double pose[12];
    swift_legacy::native_pose(R, T, pose);
    objects_[id].has_boxes = false;
    check(swiftprox_scene_set_pose(scene_, objects_[id].native, pose), "Set_Object_Transformation");
}

inline void SWIFT_Scene::place_all(const SWIFT_Real* R, const SWIFT_Real* T)
{
    std::vector<double> poses;
    std::size_t at = 0;
    for (std::size_t i = 0; i < objects_.created().size(); ++i) {
        if (!objects_[objects_.created()[i]].is_fixed) {
            double pose[12];
            swift_legacy::native_pose(R + (T == NULL ? 12 : 9) * at, T == NULL ? NULL : T + 3 * at, pose);
            poses.insert(poses.end(), pose, pose + 12);
            ++at;
        }
    }
    if (at > 0) {
        objects_.forget_boxes();
        check(swiftprox_scene_set_all_poses(scene_, &poses[0], at), "Set_All_Object_Transformations");
    }
}

inline void SWIFT_Scene::Set_Object_Transformation(int id, const SWIFT_Real* R, const SWIFT_Real* T)
{
    if (R == NULL || T == NULL) {
        swift_legacy::report("Error (Set_Object_Transformation): no matrix is given");
        return;
    }
    place(id, R, T);
}

inline void SWIFT_Scene::Set_Object_Transformation(int id, const SWIFT_Real* RT)
{
    if (RT == NULL) {
        swift_legacy::report("Error (Set_Object_Transformation): no matrix is given");
        return;
    }
    place(id, RT, NULL);
}

inline void SWIFT_Scene::Set_All_Object_Transformations(const SWIFT_Real* R, const SWIFT_Real* T)
{
    if (R == NULL || T == NULL) {
        swift_legacy::report("Error (Set_All_Object_Transformations): no matrices are given");
        return;
    }
    place_all(R, T);
}

inline void SWIFT_Scene::Set_All_Object_Transformations(const SWIFT_Real* RT)
{
    if (RT == NULL) {
        swift_legacy::report("Error (Set_All_Object_Transformations): no matrices are given");
        return;
    }
    place_all(RT, NULL);
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
        check(swiftprox_scene_activate_pair(scene_, objects_[id1].native, objects_[id2].native), "Activate");
    }
}

inline void SWIFT_Scene::Activate(int id)
{
    if (has_object(id, "Activate(id)")) {
        check(swiftprox_scene_activate_object(scene_, objects_[id].native), "Activate");
    }
}

inline void SWIFT_Scene::Activate()
{
    check(swiftprox_scene_activate_all(scene_), "Activate");
}

inline void SWIFT_Scene::Deactivate(int id1, int id2)
{
    if (has_pair(id1, id2, "Deactivate(id1,id2)")) {
        check(swiftprox_scene_deactivate_pair(scene_, objects_[id1].native, objects_[id2].native), "Deactivate");
    }
}

inline void SWIFT_Scene::Deactivate(int id)
{
    if (has_object(id, "Deactivate(id)")) {
        check(swiftprox_scene_deactivate_object(scene_, objects_[id].native), "Deactivate");
    }
}

inline void SWIFT_Scene::Deactivate()
{
    check(swiftprox_scene_deactivate_all(scene_), "Deactivate");
}

#endif
