#include "collider.h"

#include <stdlib.h>

#include <swiftprox.h>

static struct {
    const swiftprox_shape **shapes;     /* of each geom; null of other types */
    swiftprox_manifold_cache **caches;  /* of each pair of geoms, made when MuJoCo first asks of it */
    int geom_count;
    mjfCollision before[mjNGEOMTYPES][mjNGEOMTYPES];
} collider;

/* The table is read with the smaller type first. */
static const int PAIRS[][2] = {{mjGEOM_BOX, mjGEOM_BOX}, {mjGEOM_BOX, mjGEOM_MESH}, {mjGEOM_MESH, mjGEOM_MESH}};
enum { PAIR_COUNT = sizeof PAIRS / sizeof *PAIRS };

/* The shape of a geom in its own frame, which is that of geom_xpos and geom_xmat; null for other types. */
static swiftprox_status make_shape(const mjModel *model, int geom, const swiftprox_shape **shape)
{
    *shape = NULL;
    if (model->geom_type[geom] == mjGEOM_BOX) {
        double corners[8][3];
        for (int i = 0; i < 8; i++) {
            for (int k = 0; k < 3; k++) {
                corners[i][k] = (i >> k & 1 ? 1 : -1) * model->geom_size[3 * geom + k];
            }
        }
        return swiftprox_shape_create_from_points(corners[0], 8, NULL, shape);
    }
    if (model->geom_type[geom] != mjGEOM_MESH) {
        return SWIFTPROX_OK;
    }
    /* MuJoCo turns meshes into their principal axes and keeps them in floats: faces of many sides are flat no more. */
    const int mesh = model->geom_dataid[geom], count = model->mesh_vertnum[mesh];
    const float *const from = model->mesh_vert + 3 * model->mesh_vertadr[mesh];
    double *const points = malloc(3 * (size_t)count * sizeof *points);
    if (!points) {
        return SWIFTPROX_ERROR_MEMORY;
    }
    for (int i = 0; i < 3 * count; i++) {
        points[i] = (double)from[i];
    }
    const swiftprox_status status = swiftprox_shape_create_from_points(points, (size_t)count, NULL, shape);
    free(points);
    return status;
}

/* Row-major [R|T] of a geom. */
static void pose_of(const mjData *data, int geom, double *pose)
{
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            pose[4 * row + column] = data->geom_xmat[9 * geom + 3 * row + column];
        }
        pose[4 * row + 3] = data->geom_xpos[3 * geom + row];
    }
}

/* What MuJoCo calls for each pair that its broad phase finds: the points where two geoms meet, or are less than `margin` apart. */
static int collide(const mjModel *model, mjData *data, mjPreContact *contacts, int geom1, int geom2, mjtNum margin)
{
    (void)model;
    swiftprox_manifold_cache **const cache = &collider.caches[geom1 * collider.geom_count + geom2];
    if (!*cache && !(*cache = calloc(1, sizeof **cache))) {
        mju_error("no memory for a pair's cache");
    }
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    config.max_distance = margin;
    config.reduces = 1;
    double pose1[12], pose2[12];
    pose_of(data, geom1, pose1);
    pose_of(data, geom2, pose2);
    swiftprox_manifold manifold;
    swiftprox_manifold_point points[4];
    if (swiftprox_pair_manifold((swiftprox_placed){collider.shapes[geom1], pose1},
                                (swiftprox_placed){collider.shapes[geom2], pose2}, *cache, &config,
                                (swiftprox_manifold_room){points, 4, NULL}, &manifold) != SWIFTPROX_OK) {
        mju_warning("swiftprox: %s", swiftprox_library_last_error_message());
        return 0;
    }
    for (uint32_t i = 0; i < manifold.point_count; i++) {
        contacts[i].dist = 0.5 * (points[i].gap_lower + points[i].gap_upper);
        for (int k = 0; k < 3; k++) {
            contacts[i].pos[k] = 0.5 * (points[i].world1[k] + points[i].world2[k]);
            contacts[i].normal[k] = -manifold.normal[k]; /* MuJoCo's goes from geom 1 to geom 2 */
            contacts[i].tangent[k] = 0;                  /* MuJoCo chooses one */
        }
    }
    return (int)manifold.point_count;
}

bool collider_install(const mjModel *model)
{
    const size_t count = (size_t)model->ngeom;
    collider.geom_count = (int)count;
    collider.shapes = calloc(count, sizeof *collider.shapes);
    collider.caches = calloc(count * count, sizeof *collider.caches);
    bool made = collider.shapes && collider.caches;
    for (int geom = 0; made && geom < model->ngeom; geom++) {
        made = make_shape(model, geom, &collider.shapes[geom]) == SWIFTPROX_OK;
    }
    for (int i = 0; i < PAIR_COUNT; i++) {
        mjfCollision *const entry = &mjCOLLISIONFUNC[PAIRS[i][0]][PAIRS[i][1]];
        collider.before[PAIRS[i][0]][PAIRS[i][1]] = *entry;
        *entry = collide;
    }
    if (!made) {
        collider_remove();
    }
    return made;
}

void collider_remove(void)
{
    for (int i = 0; i < PAIR_COUNT; i++) {
        mjCOLLISIONFUNC[PAIRS[i][0]][PAIRS[i][1]] = collider.before[PAIRS[i][0]][PAIRS[i][1]];
    }
    for (int i = 0; collider.shapes && i < collider.geom_count; i++) {
        swiftprox_shape_release(collider.shapes[i]);
    }
    for (int i = 0; collider.caches && i < collider.geom_count * collider.geom_count; i++) {
        free(collider.caches[i]);
    }
    free(collider.shapes);
    free(collider.caches);
    collider.shapes = NULL;
    collider.caches = NULL;
}
