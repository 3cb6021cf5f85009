/* Compounds as objects of a scene, from C: what finds them, and what is refused. */
#include "check.h"

#include "swiftprox/compound.h"
#include "swiftprox/scene.h"
#include "swiftprox/sets.h"

/* Two compounds of two cubes each, at -1 and 1 along x. */
struct compound_scene {
    const swiftprox_shape *cube;
    const swiftprox_compound *compound;
    swiftprox_scene *scene;
    swiftprox_object_id bodies[2];
};

static struct compound_scene begin(double y)
{
    const double half[3] = {0.5, 0.5, 0.5};
    const double poses[24] = {1, 0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0};
    struct compound_scene begun = {0};
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    CHECK_OK(swiftprox_shape_create_box(half, 0, &begun.cube));
    const swiftprox_shape *const cubes[2] = {begun.cube, begun.cube};
    CHECK_OK(swiftprox_compound_create(cubes, poses, 2, &begun.compound));
    CHECK_OK(swiftprox_scene_create(NULL, &begun.scene));
    options.compound = begun.compound;
    for (int i = 0; i < 2; i++) {
        options.user_data = (uint64_t)i;
        options.pose[3] = 2 * i;
        options.pose[7] = y * i;
        CHECK_OK(swiftprox_scene_add_object(begun.scene, NULL, 0, &options, &begun.bodies[i]));
    }
    return begun;
}

static void end(const struct compound_scene *ended)
{
    CHECK_OK(swiftprox_scene_destroy(ended->scene));
    swiftprox_compound_release(ended->compound);
    swiftprox_shape_release(ended->cube);
}

static void two_compounds(void)
{
    const struct compound_scene two = begin(1.25);
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    query.max_distance = 1;
    CHECK_OK(swiftprox_scene_query_distance(two.scene, &query, &answer));
    CHECK(answer.count == 1 && answer.pairs[0].answer.lower <= 0.25 && answer.pairs[0].answer.upper >= 0.25);
    CHECK(answer.pairs[0].piece1 == 1 && answer.pairs[0].piece2 == 0);
    CHECK_OK(swiftprox_scene_query_intersection(two.scene, &query, &answer));
    CHECK(!answer.intersecting);
    query.max_distance = 0.5;
    query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    CHECK_OK(swiftprox_scene_query_contact(two.scene, &query, &answer));
    CHECK(answer.count == 1 && answer.contact_count == 1 && answer.contacts[0].manifold.point_count == 4);
    end(&two);
}

static void what_is_refused(void)
{
    const struct compound_scene two = begin(3);
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_info info = {.struct_size = sizeof info};
    swiftprox_object_id id;
    options.compound = two.compound;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "add one object for each",
                swiftprox_scene_add_object(two.scene, &two.cube, 1, &options, &id));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "options[0].ground or compound is set",
                swiftprox_scene_add_objects(two.scene, &two.cube, &options, 1, &id));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "is a compound",
                swiftprox_scene_set_piece_pose(two.scene, two.bodies[0], 0, options.pose));
    CHECK_OK(swiftprox_scene_get_object_info(two.scene, two.bodies[0], &info));
    CHECK(info.compound == two.compound && info.piece_count == 0 && !info.fixed && !info.ground);
    info.compound = NULL;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "info->ground or compound",
                swiftprox_scene_set_object_info(two.scene, two.bodies[0], &info));
    end(&two);
}

int main(void)
{
    two_compounds();
    what_is_refused();
    return check_report("compound objects");
}
