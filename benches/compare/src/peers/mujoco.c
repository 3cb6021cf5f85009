/* MuJoCo's mj_geomDistance of two mesh geoms, placed by writing their poses into mjData. Its meshes have vertices of single
 * precision, in the axes of their inertia. And its contacts of the two, by the function that a step calls. */

#include <math.h>
#include <mujoco/mujoco.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "peer.h"

struct peer {
    mjModel *model;
    mjData *data;
    mjtNum *poses; /* of each geom the position, then the rotation */
};

enum { POSE = 12 };
static const double FARTHEST = 100, NEAREST = 1e-12; /* up to how far apart distances are asked for, and verdicts */

void mujoco_peer_free(struct peer *peer)
{
    if (peer->data)
        mj_deleteData(peer->data);
    if (peer->model)
        mj_deleteModel(peer->model);
    free(peer->poses);
    free(peer);
}

/* A mesh of single precision under a name; false without memory. */
static bool add_mesh(mjSpec *spec, const char *name, const struct peer_mesh *mesh)
{
    float *vertices = malloc(3 * mesh->vertex_count * sizeof *vertices);
    if (!vertices)
        return false;
    for (size_t i = 0; i < 3 * mesh->vertex_count; ++i)
        vertices[i] = (float)mesh->vertices[i];
    mjsMesh *hull = mjs_addMesh(spec, NULL);
    mjs_setName(hull->element, name);
    mjs_setFloat(hull->uservert, vertices, (int)(3 * mesh->vertex_count));
    mjs_setInt(hull->userface, (const int *)mesh->corners, (int)(3 * mesh->triangle_count));
    free(vertices);
    mjsGeom *geom = mjs_addGeom(mjs_findBody(spec, "world"), NULL);
    geom->type = mjGEOM_MESH;
    mjs_setString(geom->meshname, name);
    return true;
}

struct peer *mujoco_peer_create(const struct peer_mesh meshes[2], double tolerance)
{
    struct peer *peer = calloc(1, sizeof *peer);
    if (!peer)
        return NULL;
    mjSpec *spec = mj_makeSpec();
    spec->option.ccd_tolerance = tolerance;
    if (add_mesh(spec, "first", &meshes[0]) && add_mesh(spec, "second", &meshes[1]))
        peer->model = mj_compile(spec, NULL);
    mj_deleteSpec(spec);
    peer->data = peer->model ? mj_makeData(peer->model) : NULL;
    if (!peer->data) {
        mujoco_peer_free(peer);
        return NULL;
    }
    return peer;
}

/* The frame of a geom of a body at the pose m. */
static void place(const mjModel *model, int geom, const double *m, mjtNum *placed)
{
    const mjtNum at[3] = {m[3], m[7], m[11]};
    const mjtNum turned[9] = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    mjtNum own[9];
    mju_quat2Mat(own, model->geom_quat + 4 * geom);
    mju_mulMatVec(placed, turned, model->geom_pos + 3 * geom, 3, 3);
    mju_addTo3(placed, at);
    mju_mulMatMat(placed + 3, turned, own, 3, 3, 3);
}

void mujoco_peer_load(struct peer *peer, const double *poses, size_t count)
{
    free(peer->poses);
    peer->poses = malloc(2 * count * POSE * sizeof *peer->poses);
    if (!peer->poses)
        abort();
    for (size_t i = 0; i < 2 * count; ++i)
        place(peer->model, (int)(i % 2), poses + 12 * i, peer->poses + POSE * i);
}

void mujoco_peer_forget(struct peer *peer)
{
    (void)peer;
}

static void place_both(struct peer *peer, size_t i)
{
    const mjtNum *poses = peer->poses + 2 * POSE * i;
    for (int k = 0; k < 2; ++k) {
        memcpy(peer->data->geom_xpos + 3 * k, poses + POSE * k, 3 * sizeof *poses);
        memcpy(peer->data->geom_xmat + 9 * k, poses + POSE * k + 3, 9 * sizeof *poses);
    }
}

/* The signed distance where it is less than `most`, else that, and along what. */
static double ask(struct peer *peer, size_t i, double most, double normal[3])
{
    place_both(peer, i);
    mjtNum points[6];
    const mjtNum distance = mj_geomDistance(peer->model, peer->data, 0, 1, most, points);
    for (int k = 0; k < 3; ++k)
        normal[k] = points[3 + k] - points[k];
    return distance;
}

double mujoco_distance(struct peer *peer, size_t i, double normal[3])
{
    const double distance = ask(peer, i, FARTHEST, normal);
    return distance < 0 ? 0 : distance;
}

double mujoco_verdict(struct peer *peer, size_t i, double normal[3])
{
    const double distance = ask(peer, i, NEAREST, normal);
    return distance <= 0 ? 0 : distance > 0 ? INFINITY : distance;
}

double mujoco_depth(struct peer *peer, size_t i, double normal[3])
{
    const double distance = ask(peer, i, FARTHEST, normal);
    return distance < 0 ? -distance : distance >= 0 ? 0 : distance;
}

double mujoco_manifold(struct peer *peer, size_t i, double normal[3])
{
    place_both(peer, i);
    mjPreContact contacts[mjMAXCONPAIR];
    const int count = mjCOLLISIONFUNC[mjGEOM_MESH][mjGEOM_MESH](peer->model, peer->data, contacts, 0, 1, 0);
    double deepest = 0;
    for (int k = 0; k < count; ++k) {
        if (-contacts[k].dist > deepest) {
            deepest = -contacts[k].dist;
            memcpy(normal, contacts[k].normal, 3 * sizeof *normal);
        }
    }
    return deepest;
}
