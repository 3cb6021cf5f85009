/*
 * Listeners from C: what begins, persists and ends, each listener for itself, and what a program may do wrong.
 */
#include <string.h>

#include "bodies.h"

static swiftprox_scene *scene;
static swiftprox_object_id slab, cube;

/* A slab of 4 x 4 x 1 whose top is at height 0, and a cube of side 1 that rests on it. */
static void make(void)
{
    const double half[2][3] = {{2, 2, 0.5}, {0.5, 0.5, 0.5}}, height[2] = {-0.5, 0.5};
    swiftprox_object_id *ids[2] = {&slab, &cube};
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    int body;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (body = 0; body < 2; ++body) {
        const swiftprox_shape *const shape = box(half[body][0], half[body][1], half[body][2]);
        place(options.pose, 0, 0, height[body]);
        options.user_data = 10 + (uint64_t)body;
        CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, &options, ids[body]));
        swiftprox_shape_release(shape);
    }
}

static void move_cube(double x)
{
    double pose[12];
    place(pose, x, 0, 0.5);
    CHECK_OK(swiftprox_scene_set_pose(scene, cube, pose));
}

/* How many points of the only pair are in a state. */
static size_t count(const swiftprox_listener_events *events, swiftprox_event_state state)
{
    size_t k, found = 0;
    for (k = 0; k < events->pairs[0].point_count; ++k) {
        found += events->points[events->pairs[0].first_point + k].state == state;
    }
    return found;
}

static void what_changes(void)
{
    swiftprox_listener *listener = NULL, *late = NULL;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    swiftprox_listener_events events;
    query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    CHECK_OK(swiftprox_listener_create(&listener));
    CHECK_OK(swiftprox_listener_create(&late));
    CHECK_OK(swiftprox_scene_listen(scene, listener, SWIFTPROX_QUERY_KIND_CONTACT, &query, &answer, &events));
    CHECK(answer.count == 1 && events.count == 1 && events.pairs[0].result == 0);
    CHECK(events.pairs[0].state == SWIFTPROX_EVENT_STATE_BEGAN && count(&events, SWIFTPROX_EVENT_STATE_BEGAN) == 4);
    CHECK(events.pairs[0].object1.bits == slab.bits && events.pairs[0].object2.bits == cube.bits);
    CHECK(events.pairs[0].user_data1 == 10 && events.pairs[0].user_data2 == 11);
    /* Half of it over the edge. */
    move_cube(2);
    CHECK_OK(swiftprox_scene_listen(scene, listener, SWIFTPROX_QUERY_KIND_CONTACT, &query, &answer, &events));
    CHECK(events.pairs[0].state == SWIFTPROX_EVENT_STATE_PERSISTS && events.point_count == 6);
    CHECK(count(&events, SWIFTPROX_EVENT_STATE_BEGAN) == 2 && count(&events, SWIFTPROX_EVENT_STATE_ENDED) == 2);
    CHECK(answer.point_count == 4 && answer.points[events.points[0].point].id == events.points[0].id);
    CHECK(events.points[5].state == SWIFTPROX_EVENT_STATE_ENDED && events.points[5].point == SIZE_MAX);
    /* The other one has heard nothing of that. */
    CHECK_OK(swiftprox_scene_listen(scene, late, SWIFTPROX_QUERY_KIND_INTERSECTION, NULL, &answer, &events));
    CHECK(events.count == 1 && events.pairs[0].state == SWIFTPROX_EVENT_STATE_BEGAN && events.points == NULL);
    CHECK_OK(swiftprox_scene_remove_object(scene, slab));
    CHECK_OK(swiftprox_scene_listen(scene, listener, SWIFTPROX_QUERY_KIND_CONTACT, &query, &answer, &events));
    CHECK(answer.count == 0 && events.count == 1 && events.pairs[0].state == SWIFTPROX_EVENT_STATE_ENDED);
    CHECK(events.pairs[0].objects_state == SWIFTPROX_EVENT_STATE_ENDED && events.pairs[0].result == SIZE_MAX);
    CHECK(events.pairs[0].object1.bits == slab.bits && count(&events, SWIFTPROX_EVENT_STATE_ENDED) == 4);
    CHECK_OK(swiftprox_scene_listen(scene, listener, SWIFTPROX_QUERY_KIND_CONTACT, &query, &answer, &events));
    CHECK(events.count == 0 && events.pairs == NULL && events.point_count == 0 && events.points == NULL);
    swiftprox_listener_destroy(late);
    swiftprox_listener_destroy(listener);
}

static void mistakes(void)
{
    swiftprox_listener *listener = NULL;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    swiftprox_listener_events events;
    const swiftprox_query_kind kind = SWIFTPROX_QUERY_KIND_DISTANCE;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "listener", swiftprox_listener_create(NULL));
    CHECK_OK(swiftprox_listener_create(&listener));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_listen(NULL, listener, kind, NULL, &answer, &events));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "listener", swiftprox_scene_listen(scene, NULL, kind, NULL, &answer, &events));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_scene_listen(scene, listener, kind, NULL, NULL, &events));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "events", swiftprox_scene_listen(scene, listener, kind, NULL, &answer, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "swiftprox_query_kind",
                swiftprox_scene_listen(scene, listener, (swiftprox_query_kind)9, NULL, &answer, &events));
    query.early_exit = 1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "early_exit",
                swiftprox_scene_listen(scene, listener, kind, &query, &answer, &events));
    CHECK(events.count == 0 && events.pairs == NULL && answer.count == 0);
    swiftprox_listener_destroy(listener);
    swiftprox_listener_destroy(NULL);
}

int main(void)
{
    make();
    mistakes();
    what_changes();
    CHECK_OK(swiftprox_scene_destroy(scene));
    return check_report("listener");
}
