/* swiftprox as MuJoCo's collider, by one line: mj_loadPluginLibrary(".../libswiftprox_mujoco.so"). From then on, in the whole
 * process, pairs of spheres, capsules, boxes and meshes collide by swiftprox. All other types stay MuJoCo's own: planes, height
 * fields, ellipsoids, cylinders, SDFs and flexes. The flags "nativeccd" and "multiccd" are about MuJoCo's own and change nothing
 * here: a pair has up to four contacts.
 *
 * MuJoCo calls a collider by its table mjCOLLISIONFUNC, with the model and the data of the moment, and never says that either is
 * freed. So nothing here belongs to a model:
 *
 * - A body is kept by its content: type and sizes, or the vertices of a mesh's hull as MuJoCo keeps them (scaled, hull limited by
 *   maxhullvert). Equal geoms, of copied models too, share one. Each call compares the geom with the body that it knows: another
 *   model at the same address, or a size changed between steps, is noticed.
 * - A pair is kept by the address of mjData and two geoms, with its manifold cache. The cache speeds a query up and chooses which
 *   four of many points stay; verdicts and distances do not depend on it. It is cleared at time 0 and where time has gone back, as
 *   by mj_resetData: a run repeats its bits, and so does one of new data at the address of old.
 * - At most SHARD_COUNT * SHARD_ROOM pairs are kept. Beyond that the one of its shard that was not asked for longest makes room;
 *   the last pair of a body frees it.
 *
 * Any number of threads may collide, different mjData of one model or of several. */
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <mujoco/mujoco.h>
#include <swiftprox.h>

enum {
    SHARD_COUNT = 512, /* more than threads, so that two rarely meet at a lock */
    SHARD_ROOM = 64,
    BUCKET_COUNT = 1024,
    SAMPLE_COUNT = 64, /* of a mesh's vertices, compared at each call */
    MOST_POINTS = 4,
};

static const int TYPES[] = {mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_BOX, mjGEOM_MESH};
enum { TYPE_COUNT = sizeof TYPES / sizeof *TYPES };

/* A body of one content. */
struct body {
    struct body *next;
    uint64_t hash;
    size_t users; /* pairs hold it, once or twice */
    int type;
    mjtNum size[3];               /* but of a mesh */
    int vertex_count;             /* of a mesh, else 0 */
    const swiftprox_shape *shape; /* null: refused, the pair is MuJoCo's */
    float vertices[];
};

struct key {
    const mjData *data;
    int geom1, geom2;
};

struct pair {
    struct body *body1, *body2;
    mjtNum time;   /* of the last call */
    uint64_t used; /* the shard's clock then */
    swiftprox_manifold_cache cache;
};

struct shard {
    pthread_mutex_t lock;
    uint64_t clock, answered;
    int count;
    struct key keys[SHARD_ROOM];
    struct pair *pairs[SHARD_ROOM];
};

static struct shard shards[SHARD_COUNT];
/* Locked by who holds a shard's lock or none. */
static pthread_mutex_t body_lock = PTHREAD_MUTEX_INITIALIZER;
static struct body *buckets[BUCKET_COUNT];
static size_t body_count;
static mjfCollision own[mjNGEOMTYPES][mjNGEOMTYPES];
static atomic_uint_least64_t passed_on;
static atomic_flag has_warned = ATOMIC_FLAG_INIT;

/* ---- bodies ---- */

/* The vertices of a mesh's hull as MuJoCo collides with it. */
struct vertices {
    const float *all;
    const int *ids; /* null: all of them in turn */
    int count;
};

static struct vertices vertices_of(const mjModel *model, int geom)
{
    const int mesh = model->geom_dataid[geom], graph = model->mesh_graphadr[mesh];
    const float *const all = model->mesh_vert + 3 * (size_t)model->mesh_vertadr[mesh];
    if (graph < 0) {
        return (struct vertices){all, NULL, model->mesh_vertnum[mesh]};
    }
    /* The graph: number of vertices, of faces, an address for each vertex, its number in the mesh, edges. */
    const int *const from = model->mesh_graph + graph;
    return (struct vertices){all, from + 2 + from[0], from[0]};
}

static const float *vertex(const struct vertices *vertices, int i)
{
    return vertices->all + 3 * (size_t)(vertices->ids ? vertices->ids[i] : i);
}

/* Whether a geom has a body's content; of a mesh's vertices each `step`-th is compared. MuJoCo moves a mesh to its centre of mass
 * and turns it to its axes of inertia, so two that differ anywhere differ nearly everywhere. */
static bool has_content(const struct body *body, const mjModel *model, int geom, int step)
{
    if (body->type != model->geom_type[geom]) {
        return false;
    }
    if (body->type != mjGEOM_MESH) {
        return memcmp(body->size, model->geom_size + 3 * geom, sizeof body->size) == 0;
    }
    const struct vertices vertices = vertices_of(model, geom);
    bool is_same = body->vertex_count == vertices.count;
    for (int i = 0; is_same && i < vertices.count; i += step) {
        is_same = memcmp(body->vertices + 3 * i, vertex(&vertices, i), 3 * sizeof(float)) == 0;
    }
    return is_same;
}

static int sample_step(int vertex_count)
{
    return 1 + vertex_count / SAMPLE_COUNT;
}

/* FNV-1a, Fowler, Noll & Vo. */
static uint64_t add_to_hash(uint64_t hash, const void *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        hash = (hash ^ ((const unsigned char *)bytes)[i]) * 0x100000001b3u;
    }
    return hash;
}

static uint64_t hash_of(const mjModel *model, int geom)
{
    const int type = model->geom_type[geom];
    const uint64_t hash = add_to_hash(0xcbf29ce484222325u, &type, sizeof type);
    if (type != mjGEOM_MESH) {
        return add_to_hash(hash, model->geom_size + 3 * geom, 3 * sizeof(mjtNum));
    }
    const struct vertices vertices = vertices_of(model, geom);
    uint64_t all = add_to_hash(hash, &vertices.count, sizeof vertices.count);
    for (int i = 0; i < vertices.count; i += sample_step(vertices.count)) {
        all = add_to_hash(all, vertex(&vertices, i), 3 * sizeof(float));
    }
    return all;
}

/* The shape of a body in the geom's frame, which is that of geom_xpos and geom_xmat. */
static swiftprox_status make_shape(struct body *body)
{
    const mjtNum *const size = body->size;
    switch (body->type) {
    case mjGEOM_SPHERE:
        return swiftprox_shape_create_sphere(size[0], &body->shape);
    case mjGEOM_CAPSULE:
        return swiftprox_shape_create_capsule(size[1], size[0], &body->shape);
    case mjGEOM_BOX:
        return swiftprox_shape_create_box((const double[3]){size[0], size[1], size[2]}, 0, &body->shape);
    default:
        break;
    }
    const size_t count = 3 * (size_t)body->vertex_count;
    double *const points = malloc(count * sizeof *points);
    if (!points) {
        return SWIFTPROX_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count; i++) {
        points[i] = (double)body->vertices[i];
    }
    const swiftprox_status status = swiftprox_shape_create_from_points(points, count / 3, NULL, &body->shape);
    free(points);
    return status;
}

/* Makes the body of a geom, known to nobody yet; null where memory is lacking. A body that swiftprox refuses has no shape. */
static struct body *make_body(const mjModel *model, int geom)
{
    const bool is_mesh = model->geom_type[geom] == mjGEOM_MESH;
    const struct vertices vertices = is_mesh ? vertices_of(model, geom) : (struct vertices){NULL, NULL, 0};
    struct body *const body = calloc(1, sizeof *body + 3 * sizeof(float) * (size_t)vertices.count);
    if (!body) {
        return NULL;
    }
    body->type = model->geom_type[geom];
    body->vertex_count = vertices.count;
    memcpy(body->size, model->geom_size + 3 * geom, sizeof body->size);
    for (int i = 0; i < vertices.count; i++) {
        memcpy(body->vertices + 3 * i, vertex(&vertices, i), 3 * sizeof(float));
    }
    if (make_shape(body) == SWIFTPROX_ERROR_MEMORY) {
        free(body);
        return NULL;
    }
    return body;
}

/* The body of a geom, with one user more; null where memory is lacking. */
static struct body *take_body(const mjModel *model, int geom)
{
    const uint64_t hash = hash_of(model, geom);
    struct body **const bucket = &buckets[hash % BUCKET_COUNT];
    pthread_mutex_lock(&body_lock);
    struct body *body = *bucket;
    while (body && !(body->hash == hash && has_content(body, model, geom, 1))) {
        body = body->next;
    }
    if (!body && (body = make_body(model, geom))) {
        body->hash = hash;
        body->next = *bucket;
        *bucket = body;
        body_count++;
    }
    if (body) {
        body->users++;
    }
    pthread_mutex_unlock(&body_lock);
    return body;
}

/* Takes one user away, and the body with the last. */
static void release_body(struct body *body)
{
    if (!body) {
        return;
    }
    pthread_mutex_lock(&body_lock);
    if (--body->users == 0) {
        struct body **link = &buckets[body->hash % BUCKET_COUNT];
        while (*link != body) {
            link = &(*link)->next;
        }
        *link = body->next;
        body_count--;
        swiftprox_shape_release(body->shape);
        free(body);
    }
    pthread_mutex_unlock(&body_lock);
}

/* ---- pairs; the caller holds the shard's lock ---- */

static struct shard *shard_of(struct key key)
{
    const uint64_t geoms = (uint64_t)(uint32_t)key.geom1 << 32 | (uint32_t)key.geom2;
    const uint64_t mixed = ((uint64_t)(uintptr_t)key.data ^ geoms * 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
    return &shards[(mixed ^ mixed >> 32) % SHARD_COUNT];
}

/* The number of a pair in its shard; that of a place for it, with an empty pair, where it is new; -1 where memory is lacking. */
static int find_pair(struct shard *shard, struct key key)
{
    for (int i = 0; i < shard->count; i++) {
        if (shard->keys[i].data == key.data && shard->keys[i].geom1 == key.geom1 && shard->keys[i].geom2 == key.geom2) {
            return i;
        }
    }
    int place = 0;
    if (shard->count < SHARD_ROOM) {
        struct pair *const pair = calloc(1, sizeof *pair);
        if (!pair) {
            return -1;
        }
        place = shard->count++;
        shard->pairs[place] = pair;
    } else {
        for (int i = 1; i < SHARD_ROOM; i++) {
            if (shard->pairs[i]->used < shard->pairs[place]->used) {
                place = i;
            }
        }
        release_body(shard->pairs[place]->body1);
        release_body(shard->pairs[place]->body2);
        memset(shard->pairs[place], 0, sizeof *shard->pairs[place]);
    }
    shard->keys[place] = key;
    return place;
}

/* Sees to it that a pair's body is that of a geom; false where memory is lacking. Another body: the cache is cleared. */
static bool renew_body(struct pair *pair, struct body **body, const mjModel *model, int geom)
{
    if (*body && has_content(*body, model, geom, sample_step((*body)->vertex_count))) {
        return true;
    }
    release_body(*body);
    *body = take_body(model, geom);
    memset(&pair->cache, 0, sizeof pair->cache);
    return *body;
}

/* ---- the collider ---- */

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

/* Asks swiftprox; `points` has room for MOST_POINTS. Null on success, else why not, a text that lives until this thread's next call
 * of swiftprox. */
static const char *find_points(struct shard *shard, const mjModel *model, struct key key, mjtNum margin,
                               swiftprox_manifold_point *points, swiftprox_manifold *manifold)
{
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    config.max_distance = margin;
    config.reduces = 1;
    const mjData *const data = key.data;
    const int place = find_pair(shard, key);
    struct pair *const pair = place < 0 ? NULL : shard->pairs[place];
    if (!pair || !renew_body(pair, &pair->body1, model, key.geom1) || !renew_body(pair, &pair->body2, model, key.geom2)) {
        return "no memory for a pair";
    }
    if (data->time == 0 || !(data->time >= pair->time)) {
        memset(&pair->cache, 0, sizeof pair->cache);
    }
    pair->time = data->time;
    pair->used = ++shard->clock;
    double pose1[12], pose2[12];
    pose_of(data, key.geom1, pose1);
    pose_of(data, key.geom2, pose2);
    if (!pair->body1->shape || !pair->body2->shape ||
        swiftprox_pair_manifold((swiftprox_placed){pair->body1->shape, pose1}, (swiftprox_placed){pair->body2->shape, pose2},
                                &pair->cache, &config, (swiftprox_manifold_room){points, MOST_POINTS, NULL},
                                manifold) != SWIFTPROX_OK) {
        return swiftprox_library_last_error_message();
    }
    shard->answered++;
    return NULL;
}

/* What MuJoCo calls for each pair that its broad phase finds: the points where two geoms meet, or are less than `margin` apart. */
static int collide(const mjModel *model, mjData *data, mjPreContact *contacts, int geom1, int geom2, mjtNum margin)
{
    const struct key key = {data, geom1, geom2};
    struct shard *const shard = shard_of(key);
    swiftprox_manifold manifold;
    swiftprox_manifold_point points[MOST_POINTS];
    pthread_mutex_lock(&shard->lock);
    const char *const failure = find_points(shard, model, key, margin, points, &manifold);
    pthread_mutex_unlock(&shard->lock);
    if (failure) {
        atomic_fetch_add_explicit(&passed_on, 1, memory_order_relaxed);
        if (!atomic_flag_test_and_set(&has_warned)) {
            mju_warning("swiftprox leaves geoms %d and %d to MuJoCo's own collider, and such pairs from now on without a word: %s",
                        geom1, geom2, failure);
        }
        return own[model->geom_type[geom1]][model->geom_type[geom2]](model, data, contacts, geom1, geom2, margin);
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

/* For tests and the curious: calls that swiftprox answered, calls passed on to MuJoCo's own, pairs and bodies that are kept now. */
struct swiftprox_mujoco_counts {
    uint64_t answered, passed_on, pairs, bodies;
};

__attribute__((visibility("default"))) void swiftprox_mujoco_get_counts(struct swiftprox_mujoco_counts *counts);

void swiftprox_mujoco_get_counts(struct swiftprox_mujoco_counts *counts)
{
    *counts = (struct swiftprox_mujoco_counts){.passed_on = atomic_load(&passed_on)};
    for (int i = 0; i < SHARD_COUNT; i++) {
        pthread_mutex_lock(&shards[i].lock);
        counts->answered += shards[i].answered;
        counts->pairs += (uint64_t)shards[i].count;
        pthread_mutex_unlock(&shards[i].lock);
    }
    pthread_mutex_lock(&body_lock);
    counts->bodies = body_count;
    pthread_mutex_unlock(&body_lock);
}

/* Runs as the library is loaded; it is never unloaded (-z nodelete). Structs of MuJoCo change from version to version. */
mjPLUGIN_LIB_INIT(swiftprox)
{
    if (mj_version() != mjVERSION_HEADER) {
        mju_warning("swiftprox: its plug-in is built for version %d of MuJoCo, this is %d: nothing is changed", mjVERSION_HEADER,
                    mj_version());
        return;
    }
    for (int i = 0; i < SHARD_COUNT; i++) {
        pthread_mutex_init(&shards[i].lock, NULL);
    }
    memcpy(own, mjCOLLISIONFUNC, sizeof own);
    /* The table is read with the smaller type first. */
    for (int i = 0; i < TYPE_COUNT; i++) {
        for (int j = i; j < TYPE_COUNT; j++) {
            mjCOLLISIONFUNC[TYPES[i]][TYPES[j]] = collide;
        }
    }
}
