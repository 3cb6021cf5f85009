/*
 * Compounds from C: answers that are known, caches of any bytes, and what a program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/compound.h"

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/* Two boxes of side 2 with a gap of 2 between them. */
static const swiftprox_compound *dumbbell(void)
{
    const swiftprox_shape *shapes[2];
    const swiftprox_compound *compound = NULL;
    double poses[24];
    shapes[0] = box(1, 1, 1);
    shapes[1] = shapes[0];
    place(poses, -2, 0, 0);
    place(poses + 12, 2, 0, 0);
    CHECK_OK(swiftprox_compound_create(shapes, poses, 2, &compound));
    swiftprox_shape_release(shapes[0]);
    return compound;
}

static swiftprox_placed_compound at(const swiftprox_compound *compound, const double *pose)
{
    swiftprox_placed_compound placed;
    placed.compound = compound;
    placed.pose = pose;
    return placed;
}

static void answers_that_are_known(void)
{
    const swiftprox_compound *body = dumbbell();
    const swiftprox_placed_compound still = at(body, identity);
    static swiftprox_compound_cache cache;
    swiftprox_compound_answer answer;
    swiftprox_compound_signed_distance_answer deep;
    swiftprox_compound_info info;
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    double pose[12];
    CHECK_OK(swiftprox_compound_get_info(body, &info));
    CHECK(info.piece_count == 2 && info.bytes > 0);
    place(pose, 0, 0, 5);
    CHECK_OK(swiftprox_compound_distance(still, at(body, pose), &cache, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.piece1 == answer.piece2 && answer.piece1 < 2);
    CHECK(answer.answer.lower <= 3 && 3 <= answer.answer.upper && answer.answer.upper - answer.answer.lower < 1e-12);
    CHECK_OK(swiftprox_compound_verify(still, at(body, pose), &answer));
    answer.answer.lower = 3.5;
    answer.answer.distance = 3.5;
    answer.answer.upper = 4;
    CHECK_FAILS(SWIFTPROX_ERROR_UNVERIFIED, "pieces", swiftprox_compound_verify(still, at(body, pose), &answer));
    CHECK_OK(swiftprox_compound_intersection(still, at(body, pose), &cache, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.answer.lower > 0 && answer.piece1 == 2);
    CHECK_OK(swiftprox_compound_verify(still, at(body, pose), &answer));
    config.max_distance = 1;
    CHECK_OK(swiftprox_compound_distance(still, at(body, pose), &cache, &config, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_BEYOND && answer.piece2 == 2 && isnan(answer.answer.normal[0]));

    memset(&cache, 0x5a, sizeof cache);
    place(pose, 3.5, 0, 0);
    CHECK_OK(swiftprox_compound_intersection(still, at(body, pose), &cache, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING && answer.piece1 == 1 && answer.piece2 == 0);
    CHECK_OK(swiftprox_compound_verify(still, at(body, pose), &answer));
    CHECK_OK(swiftprox_compound_signed_distance(still, at(body, pose), &cache, NULL, &deep));
    CHECK(deep.distance.lower <= -1.5 && -1.5 <= deep.distance.upper && deep.piece1 == 1 && deep.piece2 == 0);
    swiftprox_compound_release(body);
}

static void a_translation_that_frees(void)
{
    const swiftprox_compound *body = dumbbell();
    const swiftprox_placed_compound still = at(body, identity);
    swiftprox_compound_depth_answer deep;
    swiftprox_depth_config config = SWIFTPROX_DEPTH_CONFIG_DEFAULT;
    double pose[12];
    int unknown = 99;
    /* Each cube 0.5 deep in one above it. */
    place(pose, 0, 0, 1.5);
    CHECK_OK(swiftprox_compound_depth(still, at(body, pose), NULL, &deep));
    CHECK(deep.deepest.distance.outcome == SWIFTPROX_OUTCOME_INTERSECTING && deep.deepest.piece1 == deep.deepest.piece2);
    CHECK(deep.lower <= 0.5 + 1e-12 && 0.5 <= deep.upper && deep.upper < 0.5 + 1e-12);
    CHECK(fabs(deep.translation[2] + 0.5) < 1e-12 && fabs(deep.translation[1]) < 1e-12);
    CHECK_OK(swiftprox_compound_depth_verify(still, at(body, pose), &deep));
    deep.translation[2] = -0.25;
    CHECK_FAILS(SWIFTPROX_ERROR_UNVERIFIED, "pieces", swiftprox_compound_depth_verify(still, at(body, pose), &deep));
    memcpy(&deep.deepest.distance.outcome, &unknown, sizeof unknown);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "deepest.distance.outcome",
                swiftprox_compound_depth_verify(still, at(body, pose), &deep));
    config.step_budget = 0;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "step_budget", swiftprox_compound_depth(still, at(body, pose), &config, &deep));
    CHECK(deep.deepest.distance.outcome == SWIFTPROX_OUTCOME_NONE && isnan(deep.upper) && isnan(deep.translation[2]));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_compound_depth(still, still, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_compound_depth_verify(still, still, NULL));
    swiftprox_compound_release(body);
}

static void contacts_rays_and_points(void)
{
    const swiftprox_compound *body = dumbbell();
    const swiftprox_compound *share = swiftprox_compound_retain(body);
    const swiftprox_placed_compound still = at(body, identity);
    swiftprox_compound_contact found[4];
    swiftprox_manifold_point points[32];
    swiftprox_compound_contacts contacts = {0};
    swiftprox_compound_ray_answer hit;
    swiftprox_compound_point_answer where;
    swiftprox_ray ray = {{-9, 0, 0}, {1, 0, 0}, 0};
    double pose[12], point[3] = {2, 0, 0.25};
    const swiftprox_shape *shape;
    ray.t_max = HUGE_VAL;
    place(pose, 0, 0, 1.75);
    contacts.contacts = found;
    contacts.contact_capacity = 4;
    contacts.points = points;
    contacts.point_capacity = 32;
    CHECK_OK(swiftprox_compound_get_contacts(still, at(body, pose), NULL, &contacts));
    CHECK(contacts.contact_count == 2 && contacts.point_count == 8);
    CHECK(found[0].piece1 == 0 && found[0].piece2 == 0 && found[1].piece1 == 1 && found[1].piece2 == 1);
    CHECK(found[1].first_point == 4 && found[1].manifold.point_count == 4 && found[1].manifold.normal[2] == -1);
    contacts.contact_capacity = 1;
    contacts.point_capacity = 0;
    contacts.points = NULL;
    CHECK_OK(swiftprox_compound_get_contacts(still, at(body, pose), NULL, &contacts));
    CHECK(contacts.contact_count == 2 && contacts.point_count == 8);

    CHECK_OK(swiftprox_compound_cast_ray(still, &ray, &hit));
    CHECK(hit.answer.outcome == SWIFTPROX_RAY_OUTCOME_HIT && hit.piece == 0);
    CHECK(hit.answer.entry[0] <= 6 && 6 <= hit.answer.entry[1]);
    ray.origin[0] = 0;
    CHECK_OK(swiftprox_compound_cast_ray(still, &ray, &hit));
    CHECK(hit.piece == 1 && hit.answer.entry[0] <= 1 && 1 <= hit.answer.entry[1]);
    ray.origin[1] = 2;
    CHECK_OK(swiftprox_compound_cast_ray(still, &ray, &hit));
    CHECK(hit.answer.outcome == SWIFTPROX_RAY_OUTCOME_MISS && hit.piece == 2);

    CHECK_OK(swiftprox_compound_locate_point(still, point, &where));
    CHECK(where.answer.location == SWIFTPROX_POINT_LOCATION_INSIDE && where.piece == 1);
    CHECK(where.answer.lower <= -0.75 && -0.75 <= where.answer.upper);
    CHECK_OK(swiftprox_compound_get_piece(share, 1, &shape, pose));
    CHECK(shape != NULL && pose[3] == 2);
    swiftprox_compound_release(body);
    swiftprox_compound_release(share);
}

/* Two cubes at one corner each, as one mesh. */
static void a_mesh(void)
{
    double vertices[48];
    uint32_t corners[72];
    static const uint32_t cube[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                      2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    const swiftprox_compound *body;
    swiftprox_compound_info info;
    swiftprox_mesh mesh;
    int i, k;
    for (i = 0; i < 16; ++i) {
        for (k = 0; k < 3; ++k) {
            vertices[3 * i + k] = (i >> k & 1) + (k == 0 ? 3 * (i / 8) : 0);
        }
    }
    for (i = 0; i < 72; ++i) {
        corners[i] = cube[i % 36] + 8 * (uint32_t)(i / 36);
    }
    mesh.vertices = vertices;
    mesh.vertex_count = 16;
    mesh.indices = corners;
    mesh.valences = NULL;
    mesh.face_count = 24;
    CHECK_OK(swiftprox_compound_create_from_mesh(mesh, 0, NULL, NULL, &body));
    CHECK_OK(swiftprox_compound_get_info(body, &info));
    CHECK(info.piece_count == 2);
    swiftprox_compound_release(body);
    corners[5] = 99;
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "99", swiftprox_compound_create_from_mesh(mesh, 0, NULL, NULL, &body));
    CHECK(body == NULL);
}

/* A dumbbell falls on another one, or past it. */
static void casts(void)
{
    const swiftprox_compound *body = dumbbell();
    static swiftprox_compound_cache cache;
    swiftprox_compound_cast_answer answer;
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    swiftprox_motion still = {0}, fall = {0};
    swiftprox_moving_compound one, two;
    still.kind = SWIFTPROX_MOTION_KIND_FIXED;
    memcpy(still.start, identity, sizeof identity);
    fall.kind = SWIFTPROX_MOTION_KIND_AFFINE;
    place(fall.start, 3, 0, 10);
    place(fall.end, 3, 0, 0);
    one.compound = two.compound = body;
    one.motion = &still;
    two.motion = &fall;
    CHECK_OK(swiftprox_compound_cast(one, two, &cache, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT && answer.piece1 == 1 && answer.piece2 == 0);
    CHECK(answer.answer.time_lower <= 0.8 && 0.8 <= answer.answer.time_upper);
    CHECK(answer.answer.time_upper - answer.answer.time_lower <= 1e-9);
    CHECK_OK(swiftprox_compound_cast_verify(one, two, NULL, &answer));
    answer.answer.time_lower = 0.81;
    answer.answer.time_upper = 0.82;
    CHECK_FAILS(SWIFTPROX_ERROR_UNVERIFIED, "pieces 1 and 0", swiftprox_compound_cast_verify(one, two, NULL, &answer));
    answer.piece1 = 9;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "9", swiftprox_compound_cast_verify(one, two, NULL, &answer));

    place(fall.start, 0, 2.5, 10);
    place(fall.end, 0, 2.5, 0);
    CHECK_OK(swiftprox_compound_cast(one, two, &cache, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_CAST_OUTCOME_FREE && answer.piece1 == 2 && answer.piece2 == 2);
    CHECK(0 < answer.answer.clearance && answer.answer.clearance <= 0.5);
    CHECK_OK(swiftprox_compound_cast_verify(one, two, NULL, &answer));
    config.max_distance = 0.75;
    CHECK_OK(swiftprox_compound_cast(one, two, &cache, &config, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT);
    CHECK_OK(swiftprox_compound_cast_verify(one, two, &config, &answer));

    config.ignores_parting = 1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "ignores_parting",
                swiftprox_compound_cast(one, two, &cache, &config, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_CAST_OUTCOME_NONE && isnan(answer.answer.time_lower));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "cache", swiftprox_compound_cast(one, two, NULL, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_compound_cast(one, two, &cache, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_compound_cast_verify(one, two, NULL, NULL));
    fall.kind = 77;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "object2.motion->kind",
                swiftprox_compound_cast(one, two, &cache, NULL, &answer));
    two.motion = NULL;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object2.motion", swiftprox_compound_cast(one, two, &cache, NULL, &answer));
    one.compound = NULL;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object1.compound", swiftprox_compound_cast(one, two, &cache, NULL, &answer));
    memset(&answer, 0x77, sizeof answer);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "answer->answer->outcome",
                swiftprox_compound_cast_verify(one, two, NULL, &answer));
    swiftprox_compound_release(body);
}

static void mistakes(void)
{
    const swiftprox_compound *body = dumbbell(), *none = body;
    const swiftprox_shape *shapes[2] = {NULL, NULL};
    static swiftprox_compound_cache cache;
    swiftprox_compound_answer answer;
    swiftprox_compound_contacts contacts = {0};
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    double pose[12];
    const swiftprox_placed_compound still = at(body, identity), nowhere = at(body, NULL), nobody = at(NULL, identity);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "shapes[0]", swiftprox_compound_create(shapes, NULL, 2, &none));
    CHECK(none == NULL);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "at least one piece", swiftprox_compound_create(shapes, NULL, 0, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "compound", swiftprox_compound_create(shapes, NULL, 0, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object1.compound",
                swiftprox_compound_distance(nobody, still, &cache, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_NONE && isnan(answer.answer.lower));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object2.pose",
                swiftprox_compound_intersection(still, nowhere, &cache, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "cache", swiftprox_compound_distance(still, still, NULL, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_compound_distance(still, still, &cache, NULL, NULL));
    config.max_distance = -1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
                swiftprox_compound_distance(still, still, &cache, &config, &answer));
    place(pose, 0, 0, 0);
    pose[0] = 2;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal",
                swiftprox_compound_distance(still, at(body, pose), &cache, NULL, &answer));
    contacts.contact_capacity = 1;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "contacts->contacts",
                swiftprox_compound_get_contacts(still, still, NULL, &contacts));
    CHECK_OK(swiftprox_compound_distance(still, still, &cache, NULL, &answer));
    answer.piece2 = 7;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "7", swiftprox_compound_verify(still, still, &answer));
    memset(&answer, 0x77, sizeof answer);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "answer->answer->outcome",
                swiftprox_compound_verify(still, still, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "piece 2 of a compound that has 2",
                swiftprox_compound_get_piece(body, 2, &shapes[0], pose));
    CHECK(shapes[0] == NULL && isnan(pose[0]));
    CHECK(swiftprox_compound_retain(NULL) == NULL);
    swiftprox_compound_release(NULL);
    swiftprox_compound_release(body);
}

int main(void)
{
    answers_that_are_known();
    a_translation_that_frees();
    contacts_rays_and_points();
    a_mesh();
    casts();
    mistakes();
    return check_report("compound");
}
