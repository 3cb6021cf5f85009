/*
 * Memory from the program's own functions: all of it, aligned as asked for, each block back to the functions it came from, whatever
 * has been set meanwhile; and nothing from them where they are set no more.
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "swiftprox/process.h"

/* What a program gave and has not got back, and how many blocks it gave in all. */
typedef struct {
    long blocks, bytes, taken;
} account;

/* Stands behind each block. */
typedef struct {
    account *owner;
    size_t size, alignment;
} label;

static void *take(void *user, size_t size, size_t alignment)
{
    account *owner = (account *)user;
    const size_t behind = (sizeof(label) + alignment - 1) / alignment * alignment;
    unsigned char *block;
    label *written;
    CHECK(size > 0 && alignment >= sizeof(void *) && (alignment & (alignment - 1)) == 0 && size % alignment == 0);
    block = (unsigned char *)aligned_alloc(alignment, size + behind);
    if (block == NULL) {
        return NULL;
    }
    written = (label *)(void *)(block + size);
    written->owner = owner;
    written->size = size;
    written->alignment = alignment;
    ++owner->blocks;
    ++owner->taken;
    owner->bytes += (long)size;
    return block;
}

static void give_back(void *user, void *memory, size_t size, size_t alignment)
{
    account *owner = (account *)user;
    const label *written = (const label *)(void *)((unsigned char *)memory + size);
    CHECK(written->owner == owner && written->size == size && written->alignment == alignment);
    --owner->blocks;
    owner->bytes -= (long)size;
    free(memory);
}

/* A shape of 200 vertices on a ball. */
static const swiftprox_shape *make_ball(void)
{
    double points[600];
    const swiftprox_shape *shape = NULL;
    int i;
    for (i = 0; i < 200; ++i) {
        const double z = (2 * i + 1) / 200.0 - 1.0, r = sqrt(1.0 - z * z);
        points[3 * i] = r * cos(2.4 * i);
        points[3 * i + 1] = r * sin(2.4 * i);
        points[3 * i + 2] = z;
    }
    CHECK_OK(swiftprox_shape_create_from_points(points, 200, NULL, &shape));
    return shape;
}

/* The distance of two such balls, the centres so far apart. */
static double distance_of(const swiftprox_shape *shape, double apart)
{
    const double here[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const double there[12] = {1, 0, 0, apart, 0, 1, 0, 0, 0, 0, 1, 0};
    swiftprox_pair_cache cache;
    swiftprox_pair_answer answer;
    memset(&cache, 0, sizeof cache);
    CHECK_OK(swiftprox_pair_distance(shape, here, shape, there, &cache, NULL, &answer));
    CHECK(answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.lower <= apart - 1.9 && answer.upper >= apart - 2.0);
    return answer.distance;
}

/* Every block is a call of the program's functions, and none stays behind. */
static void test_everything_comes_from_the_program(void)
{
    static account own; /* good until the process ends, as is demanded */
    swiftprox_shape_info info;
    const swiftprox_shape *shape;
    const swiftprox_shape *piece;
    swiftprox_scene *scene = NULL;
    swiftprox_object_id id;
    long before;
    CHECK_OK(swiftprox_library_set_allocator(take, give_back, &own));
    shape = make_ball();
    memset(&info, 0, sizeof info);
    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_shape_get_info(shape, &info));
    CHECK(own.blocks > 5 && (uint64_t)own.bytes >= info.bytes);
    distance_of(shape, 3.0);
    before = own.taken;
    distance_of(shape, 3.0);
    CHECK(own.taken == before); /* queries take nothing after the first */
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    piece = shape;
    CHECK_OK(swiftprox_scene_add_object(scene, &piece, 1, NULL, &id));
    CHECK(own.taken > before);
    CHECK_OK(swiftprox_library_set_allocator(NULL, NULL, NULL));
    before = own.taken;
    swiftprox_shape_release(make_ball());
    CHECK(own.taken == before); /* from the system again */
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(shape);
    /* What a thread and the process keep until they end: the last message, the hook for panics. */
    CHECK(own.blocks <= 4 && own.bytes < 1024);
}

/* Blocks of two accounts and of the system, given back in another order under another setting; and the same answers from all. */
static void test_blocks_go_back_where_they_came_from(void)
{
    static account first, second;
    const swiftprox_shape *shapes[3];
    double distances[3];
    int i;
    CHECK_OK(swiftprox_library_set_allocator(take, give_back, &first));
    shapes[0] = make_ball();
    CHECK_OK(swiftprox_library_set_allocator(NULL, NULL, &first));
    shapes[1] = make_ball();
    CHECK_OK(swiftprox_library_set_allocator(take, give_back, &second));
    shapes[2] = make_ball();
    for (i = 0; i < 3; ++i) {
        distances[i] = distance_of(shapes[i], 2.5);
        CHECK(distances[i] == distances[0]);
    }
    CHECK(first.blocks > 5 && second.blocks > 5);
    CHECK_OK(swiftprox_library_set_allocator(take, give_back, &first));
    for (i = 2; i >= 0; --i) {
        swiftprox_shape_release(shapes[i]);
    }
    CHECK(first.blocks == 0 && first.bytes == 0 && second.blocks == 0 && second.bytes == 0);
    CHECK_OK(swiftprox_library_set_allocator(NULL, NULL, NULL));
}

static void test_half_a_pair_of_functions_is_refused(void)
{
    static account own;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "`deallocate`", swiftprox_library_set_allocator(take, NULL, &own));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "`allocate`", swiftprox_library_set_allocator(NULL, give_back, &own));
    swiftprox_shape_release(make_ball());
    CHECK(own.taken == 0);
}

int main(void)
{
    test_everything_comes_from_the_program();
    test_blocks_go_back_where_they_came_from();
    test_half_a_pair_of_functions_is_refused();
    return check_report("allocator");
}
