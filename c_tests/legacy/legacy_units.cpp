/*
 * Two units that include SWIFT.h link into one program, and it stands beside swiftprox.h: an old program that is moved call by
 * call.
 */
#include <SWIFT_array.h>
#include <SWIFT_common.h>
#include <SWIFT_config.h>
#include <SWIFT_fileio.h>

#include <SWIFT.h>
#include <swiftprox.h>
#include <swiftprox/scene.h>

#include "check.h"
#include "legacy_units.h"

#if defined(min) || defined(max)
#error "they break <algorithm>"
#endif

int main()
{
    SWIFT_Scene old_scene(false);
    CHECK(add_unit_box(&old_scene) == 0 && add_unit_box(&old_scene) == 1);
    CHECK(other_default() == &DEFAULT_ORIENTATION);
    const SWIFT_Real R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, T[3] = {3, 0, 0};
    old_scene.Set_Object_Transformation(1, R, T);
    int pairs, *ids;
    SWIFT_Real* distances;
    CHECK(!old_scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1);

    /* The same, with the interface of C, and with the old scene's own shapes. */
    const swiftprox_shape* shape = NULL;
    swiftprox_scene* scene = NULL;
    CHECK_OK(swiftprox_scene_get_piece(old_scene.Get_Native_Scene(), old_scene.Get_Native_Object(0), 0, &shape));
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    swiftprox_object_id objects[2];
    CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, NULL, &objects[0]));
    CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, NULL, &objects[1]));
    const double pose[12] = {1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0};
    CHECK_OK(swiftprox_scene_set_pose(scene, objects[1], pose));
    swiftprox_scene_answer answer;
    CHECK_OK(swiftprox_scene_query_distance(scene, NULL, &answer));
    CHECK(answer.count == 1 && !(answer.pairs[0].answer.distance < distances[0]) && !(answer.pairs[0].answer.distance > distances[0]));
    CHECK_OK(swiftprox_scene_destroy(scene));
    return check_report("legacy_units");
}
