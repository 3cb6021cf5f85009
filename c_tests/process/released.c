/* Calls with shapes, grounds, compounds and scenes that were given back: each is refused with a message until other data take their
 * memory. Not under valgrind, which reports such a call first. */
#include "check.h"

#include <swiftprox.h>
#include <swiftprox/compound.h>
#include <swiftprox/draw.h>
#include <swiftprox/ground.h>
#include <swiftprox/scene.h>

#include <string.h>

static const double HERE[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
static const double THERE[12] = {1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0};

static const swiftprox_shape *box(void)
{
    const double half[3] = {1, 1, 1};
    const swiftprox_shape *shape = NULL;
    CHECK_OK(swiftprox_shape_create_box(half, 0, &shape));
    return shape;
}

static int is_told(const char *words)
{
    return strstr(swiftprox_library_last_error_message(), words) != NULL;
}

static void released_shapes(void)
{
    const swiftprox_shape *const shape = box(), *const other = box();
    swiftprox_pair_cache cache = {{0}};
    swiftprox_pair_answer answer;
    swiftprox_scene *scene = NULL;
    swiftprox_object_id id;
    const swiftprox_draw draw = SWIFTPROX_DRAW_DEFAULT;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    /* A share is enough. */
    CHECK(swiftprox_shape_retain(shape) == shape);
    swiftprox_shape_release(shape);
    CHECK_OK(swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){other, THERE}, &cache, NULL, &answer));
    swiftprox_shape_release(shape);
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`object1.shape` is no living shape: it was released",
                swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){other, THERE}, &cache, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`object2.shape` is no living shape",
                swiftprox_pair_distance((swiftprox_placed){other, HERE}, (swiftprox_placed){shape, THERE}, &cache, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`object.shape` is no living shape",
                swiftprox_shape_draw((swiftprox_placed){shape, HERE}, &draw));
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`object2.shape` is no living shape",
                swiftprox_pair_draw((swiftprox_placed){other, HERE}, (swiftprox_placed){shape, THERE}, NULL, &draw));
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "is no living shape", swiftprox_scene_add_object(scene, &shape, 1, NULL, &id));
    CHECK(swiftprox_shape_retain(shape) == NULL && is_told("is no living shape"));
    swiftprox_shape_release(shape);
    CHECK(is_told("`shape` is no living shape"));
    swiftprox_shape_release(other);
    CHECK_OK(swiftprox_scene_destroy(scene));
}

static void released_grounds_and_compounds(void)
{
    const double heights[4] = {0, 0, 0, 0};
    const swiftprox_ground *ground = NULL, *solid = NULL;
    const swiftprox_shape *const shape = box();
    const swiftprox_compound *compound = NULL;
    swiftprox_compound_info info = {0};
    CHECK_OK(swiftprox_ground_create_from_heights(2, 2, 1, 1, heights, &ground));
    swiftprox_ground_release(ground);
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`ground` is no living ground", swiftprox_ground_create_solid(ground, 1, &solid));
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`ground` is no living ground", swiftprox_ground_copy_triangles(ground, 0, 0, NULL, NULL));
    CHECK(swiftprox_ground_retain(ground) == NULL);
    swiftprox_ground_release(ground);
    CHECK(is_told("is no living ground"));
    CHECK_OK(swiftprox_compound_create(&shape, NULL, 1, &compound));
    swiftprox_compound_release(compound);
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`compound` is no living compound", swiftprox_compound_get_info(compound, &info));
    CHECK(swiftprox_compound_retain(compound) == NULL);
    swiftprox_compound_release(compound);
    CHECK(is_told("is no living compound"));
    swiftprox_shape_release(shape);
}

static void destroyed_scenes(void)
{
    swiftprox_scene *scene = NULL;
    swiftprox_scene_answer answer;
    const swiftprox_draw draw = SWIFTPROX_DRAW_DEFAULT;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    CHECK_OK(swiftprox_scene_destroy(scene));
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`scene` is no living scene", swiftprox_scene_draw(scene, &draw));
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`scene` is no living scene", swiftprox_scene_query_distance(scene, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "`scene` is no living scene", swiftprox_scene_destroy(scene));
}

int main(void)
{
    released_shapes();
    released_grounds_and_compounds();
    destroyed_scenes();
    return check_report("released");
}
