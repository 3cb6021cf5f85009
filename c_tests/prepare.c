/*
 * swift_shape_prepare of a body that gets automatic levels of detail: it tells how far it is, and cancelled anywhere it leaves a
 * shape that answers as ever and can be prepared again.
 */
#include <math.h>
#include <stddef.h>

#include "check.h"

enum { COUNT = 30001 };

/* What the callback was told, and from which fraction on it says stop. */
typedef struct told {
    int count;
    double last;
    double stop_at;
} told;

static int32_t tell(void *user, double fraction)
{
    told *const told = user;
    CHECK(fraction >= told->last && fraction <= 1);
    ++told->count;
    told->last = fraction;
    return fraction >= told->stop_at;
}

static swift_shape_info info_of(const swift_shape *shape)
{
    swift_shape_info info = {sizeof info};
    CHECK_OK(swift_shape_get_info(shape, &info));
    return info;
}

/* The distance of two such bodies, two radii apart. */
static void check_distance(const swift_shape *shape)
{
    static const double here[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, there[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4};
    swift_pair_cache cache = {{0}};
    swift_pair_answer answer;
    CHECK_OK(swift_pair_distance(shape, here, shape, there, &cache, NULL, &answer));
    CHECK(fabs(answer.distance - 2) < 1e-3);
    CHECK_OK(swift_pair_verify(shape, here, shape, there, &answer));
}

int main(void)
{
    static double points[3 * COUNT];
    static const double stops[] = {0, 0.25, 0.5, 0.75, 1};
    swift_shape *shape;
    swift_shape_info info;
    told told = {0, 0, 2};
    for (int i = 0; i < COUNT; ++i) { /* a spiral around the sphere */
        const double z = 1 - (2 * i + 1.0) / COUNT, r = sqrt(1 - z * z);
        points[3 * i] = r * cos(2.4 * i);
        points[3 * i + 1] = r * sin(2.4 * i);
        points[3 * i + 2] = z;
    }
    CHECK(swift_shape_prepare(NULL, tell, &told) == SWIFT_ERROR_NULL_POINTER && told.count == 0);
    if (!CHECK_OK(swift_shape_create_from_points(points, COUNT, NULL, &shape)))
        return check_report("prepare");
    CHECK(info_of(shape).level_count == 0 && info_of(shape).hierarchy == SWIFT_HIERARCHY_AUTOMATIC);

    for (size_t i = 0; i < sizeof stops / sizeof stops[0]; ++i) {
        told.count = 0;
        told.last = 0;
        told.stop_at = stops[i];
        CHECK_FAILS(SWIFT_ERROR_CANCELLED, "progress callback", swift_shape_prepare(shape, tell, &told));
        CHECK(told.count > 0 && told.last >= stops[i]);
        CHECK(info_of(shape).level_count == 0);
        check_distance(shape);
    }

    told.count = 0;
    told.last = 0;
    told.stop_at = 2;
    CHECK_OK(swift_shape_prepare(shape, tell, &told));
    CHECK(told.count > 10 && told.last == 1);
    info = info_of(shape);
    CHECK(info.level_count > 0 && info.lookup_bytes > 0);
    check_distance(shape);

    /* What is made is not made again; without a callback, too. */
    told.count = 0;
    told.last = 0;
    CHECK_OK(swift_shape_prepare(shape, tell, &told));
    CHECK(told.count == 2 && told.last == 1);
    CHECK_OK(swift_shape_prepare(shape, NULL, NULL));
    CHECK(info_of(shape).bytes == info.bytes);
    CHECK_OK(swift_shape_release(shape));

    CHECK_OK(swift_shape_create_from_points(points, COUNT, NULL, &shape));
    CHECK_OK(swift_shape_prepare(shape, NULL, NULL));
    CHECK(info_of(shape).bytes == info.bytes);
    CHECK_OK(swift_shape_release(shape));
    return check_report("prepare");
}
