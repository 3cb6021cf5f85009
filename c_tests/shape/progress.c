/*
 * What tells how far it is and can be cancelled besides making a shape: swiftprox_shape_prepare of a body that gets automatic
 * levels of detail, which leaves a shape that answers as ever and can be prepared again, and swiftprox_shape_load.
 *
 *     progress [folder for the file that it writes]
 */
#include <math.h>
#include <stddef.h>

#include "check.h"
#include "swiftprox/tuning.h"
#include "swiftprox/geometry.h"
#include "swiftprox/verify.h"

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

static swiftprox_shape_info info_of(const swiftprox_shape *shape)
{
    swiftprox_shape_info info = {sizeof info};
    CHECK_OK(swiftprox_shape_get_info(shape, &info));
    return info;
}

static swiftprox_shape_tuning_info tuning_of(const swiftprox_shape *shape)
{
    swiftprox_shape_tuning_info info = {sizeof info};
    CHECK_OK(swiftprox_shape_get_tuning_info(shape, &info));
    return info;
}

/* The distance of two such bodies, two radii apart. */
static void check_distance(const swiftprox_shape *shape)
{
    static const double here[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, there[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4};
    swiftprox_pair_cache cache = {{0}};
    swiftprox_pair_answer answer;
    CHECK_OK(swiftprox_pair_distance(shape, here, shape, there, &cache, NULL, &answer));
    CHECK(fabs(answer.distance - 2) < 1e-3);
    CHECK_OK(swiftprox_pair_verify(shape, here, shape, there, &answer));
}

/* Saved and loaded again; the load tells how far it is, and cancelled anywhere there is no shape. */
static void check_loading(const swiftprox_shape *shape, const char *folder)
{
    char path[1024];
    const swiftprox_shape *loaded = (const swiftprox_shape *)(void *)path; /* not null: a failure must make it so */
    told told = {0, 0, 2};
    snprintf(path, sizeof path, "%s/progress.shape", folder);
    CHECK_OK(swiftprox_shape_save(shape, path));
    for (int i = 0; i <= 4; ++i) {
        told.last = 0;
        told.stop_at = 0.25 * i;
        CHECK_FAILS(SWIFTPROX_ERROR_CANCELLED, "progress callback", swiftprox_shape_load(path, tell, &told, &loaded));
        CHECK(loaded == NULL && told.last >= told.stop_at);
    }
    told.count = 0;
    told.last = 0;
    told.stop_at = 2;
    CHECK_OK(swiftprox_shape_load(path, tell, &told, &loaded));
    CHECK(told.count > 5 && told.last == 1);
    check_distance(loaded);
    swiftprox_shape_release(loaded);
    CHECK_OK(swiftprox_shape_load(path, NULL, NULL, &loaded));
    swiftprox_shape_release(loaded);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "path", swiftprox_shape_load(NULL, tell, &told, &loaded));
    remove(path);
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "progress.shape: cannot be read: ", swiftprox_shape_load(path, tell, &told, &loaded));
    CHECK(loaded == NULL);
}

int main(int argument_count, char **arguments)
{
    static double points[3 * COUNT];
    static const double stops[] = {0, 0.25, 0.5, 0.75, 1};
    const swiftprox_shape *shape;
    swiftprox_shape_info info;
    told told = {0, 0, 2};
    for (int i = 0; i < COUNT; ++i) { /* a spiral around the sphere */
        const double z = 1 - (2 * i + 1.0) / COUNT, r = sqrt(1 - z * z);
        points[3 * i] = r * cos(2.4 * i);
        points[3 * i + 1] = r * sin(2.4 * i);
        points[3 * i + 2] = z;
    }
    CHECK(swiftprox_shape_prepare(NULL, tell, &told) == SWIFTPROX_ERROR_NULL_POINTER && told.count == 0);
    if (!CHECK_OK(swiftprox_shape_create_from_points(points, COUNT, NULL, &shape)))
        return check_report("progress");
    CHECK(tuning_of(shape).level_count == 0 && tuning_of(shape).hierarchy == SWIFTPROX_HIERARCHY_AUTOMATIC);

    for (size_t i = 0; i < sizeof stops / sizeof stops[0]; ++i) {
        told.count = 0;
        told.last = 0;
        told.stop_at = stops[i];
        CHECK_FAILS(SWIFTPROX_ERROR_CANCELLED, "progress callback", swiftprox_shape_prepare(shape, tell, &told));
        CHECK(told.count > 0 && told.last >= stops[i]);
        CHECK(tuning_of(shape).level_count == 0);
        check_distance(shape);
    }

    told.count = 0;
    told.last = 0;
    told.stop_at = 2;
    CHECK_OK(swiftprox_shape_prepare(shape, tell, &told));
    CHECK(told.count > 10 && told.last == 1);
    info = info_of(shape);
    CHECK(tuning_of(shape).level_count > 0 && tuning_of(shape).lookup_bytes > 0);
    check_distance(shape);

    /* What is made is not made again; without a callback, too. */
    told.count = 0;
    told.last = 0;
    CHECK_OK(swiftprox_shape_prepare(shape, tell, &told));
    CHECK(told.count == 2 && told.last == 1);
    CHECK_OK(swiftprox_shape_prepare(shape, NULL, NULL));
    CHECK(info_of(shape).bytes == info.bytes);
    check_loading(shape, argument_count > 1 ? arguments[1] : ".");
    swiftprox_shape_release(shape);

    CHECK_OK(swiftprox_shape_create_from_points(points, COUNT, NULL, &shape));
    CHECK_OK(swiftprox_shape_prepare(shape, NULL, NULL));
    CHECK(info_of(shape).bytes == info.bytes);
    swiftprox_shape_release(shape);
    return check_report("progress");
}
