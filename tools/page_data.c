#include "page_data.h"
#include <swiftprox/compound.h>
#include <swiftprox/draw.h>
#include <swiftprox/scene.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "program.h"

/* How large a page may get for its pairs to be kept, and how many pairs a step may keep however large it gets: their marches are
 * drawn. */
static const size_t LIMIT = 56 * 1000 * 1000;
static const size_t LEAST_PAIRS = 16;

/* What tools/page_file.c writes of each. */
enum {
    MOVE_BYTES = 4 + 3 * 4 + 4 * 2,
    PAIR_BYTES = 2 * 4 + 11 + 3 * 8,
    POINTS_BYTES = 9 * 8 + 4 * 4,
    CONTACT_BYTES = 6 * 4 + 2 * 8,
    LINE_BYTES = 6 * 4 + 1,
    BODY_BYTES = 4 * 4,
    STEP_BYTES = (5 + PAGE_DECISIONS + PAGE_LEVELS) * 4,
    VERTEX_BYTES = 3 * 4,
    TRIANGLE_BYTES = 3 * 4,
};

static int out_of_memory(void)
{
    fputs("swiftprox-replay: no memory for the page\n", stderr);
    return FAILED;
}

/* The array with room for `count` items, or null, and then it is as it was. */
static void *with_room(void *items, size_t *capacity, size_t count, size_t size)
{
    if (count <= *capacity && items) {
        return items;
    }
    const size_t wanted = count < 32 ? 64 : 2 * count;
    void *const grown = wanted <= SIZE_MAX / size ? realloc(items, wanted * size) : NULL;
    if (grown) {
        *capacity = wanted;
    }
    return grown;
}

struct page_data page_data_start(void)
{
    return (struct page_data){.most_pairs = SIZE_MAX};
}

void page_data_free(struct page_data *data)
{
    for (size_t i = 0; i < data->shape_count; i++) {
        swiftprox_shape_release(data->shapes[i].shape);
        swiftprox_ground_release(data->shapes[i].ground);
    }
    for (size_t i = 0; i < data->step_count; i++) {
        free(data->steps[i].pairs);
        free(data->steps[i].contacts);
        free(data->steps[i].lines);
    }
    free(data->shapes);
    free(data->bodies);
    free(data->objects);
    free(data->moves);
    free(data->steps);
    free(data->ids);
}

/* ---- bodies ---- */

/* The number of the shape or the ground, which joins the page if it is new; PAGE_NO_BODY after a message. Scenes have few. */
static uint32_t number_shape(struct page_data *data, const swiftprox_shape *shape, const swiftprox_ground *ground)
{
    for (size_t i = data->shape_count; i > 0; i--) {
        if (data->shapes[i - 1].shape == shape && data->shapes[i - 1].ground == ground) {
            return (uint32_t)(i - 1);
        }
    }
    struct page_shape *const shapes =
        with_room(data->shapes, &data->shape_capacity, data->shape_count + 1, sizeof *data->shapes);
    if (!shapes) {
        out_of_memory();
        return PAGE_NO_BODY;
    }
    data->shapes = shapes;
    struct page_shape *const added = &shapes[data->shape_count];
    added->info = (swiftprox_shape_info){.struct_size = sizeof added->info};
    const swiftprox_status status =
        ground ? page_ground_measure(ground, &added->info) : swiftprox_shape_get_info(shape, &added->info);
    if (status != SWIFTPROX_OK) {
        player_failed();
        return PAGE_NO_BODY;
    }
    added->shape = swiftprox_shape_retain(shape);
    added->ground = swiftprox_ground_retain(ground);
    return (uint32_t)data->shape_count++;
}

/* A convex piece of an object or of its compound, and its pose there, which objects do not tell. */
static swiftprox_status get_piece(const struct player *player, swiftprox_object_id id, const swiftprox_object_info *info,
                                  uint32_t piece, const swiftprox_shape **shape, double local[12])
{
    return info->compound ? swiftprox_compound_get_piece(info->compound, piece, shape, local)
                          : swiftprox_scene_get_piece(player->scene, id, piece, shape);
}

/* The bodies of an object that is seen for the first time. */
static int add_bodies(struct page_data *data, const struct player *player, uint32_t number, swiftprox_object_id id)
{
    swiftprox_object_info info = {.struct_size = sizeof info};
    if (swiftprox_scene_get_object_info(player->scene, id, &info) != SWIFTPROX_OK) {
        return player_failed();
    }
    swiftprox_ground_info of_ground = {0};
    if (info.ground && swiftprox_ground_get_info(info.ground, &of_ground) != SWIFTPROX_OK) {
        return player_failed();
    }
    swiftprox_compound_info of_compound = {0};
    if (info.compound && swiftprox_compound_get_info(info.compound, &of_compound) != SWIFTPROX_OK) {
        return player_failed();
    }
    const bool is_ground = info.ground && of_ground.triangle_count <= PAGE_MOST_GROUND_TRIANGLES;
    const size_t count = is_ground ? 1 : info.piece_count + of_compound.piece_count;
    struct page_body *const bodies =
        with_room(data->bodies, &data->body_capacity, data->body_count + count, sizeof *data->bodies);
    if (!bodies) {
        return out_of_memory();
    }
    data->bodies = bodies;
    struct page_object *const object = &data->objects[number];
    *object = (struct page_object){.id = id, .first_body = (uint32_t)data->body_count};
    for (uint32_t piece = 0; piece < count; piece++) {
        struct page_body body = {.object = number, .piece = piece, .fixed = info.fixed != 0};
        const swiftprox_shape *shape = NULL;
        if (!is_ground && get_piece(player, id, &info, piece, &shape, body.local) != SWIFTPROX_OK) {
            return player_failed();
        }
        const uint32_t shape_number = number_shape(data, shape, is_ground ? info.ground : NULL);
        if (shape_number == PAGE_NO_BODY) {
            return FAILED;
        }
        body.shape = shape_number;
        bodies[data->body_count++] = body;
        object->piece_count++;
    }
    return GOOD;
}

static int see_object(struct page_data *data, const struct player *player, swiftprox_object_id id, uint32_t *number)
{
    if (!player_find_number(player, id, number)) {
        return player_failed();
    }
    if (*number >= data->object_count) {
        struct page_object *const objects =
            with_room(data->objects, &data->object_capacity, (size_t)*number + 1, sizeof *data->objects);
        if (!objects) {
            return out_of_memory();
        }
        data->objects = objects;
        while (data->object_count <= *number) {
            objects[data->object_count++] = (struct page_object){.first_body = PAGE_NO_BODY};
        }
    }
    return data->objects[*number].first_body == PAGE_NO_BODY ? add_bodies(data, player, *number, id) : GOOD;
}

/* ---- moves ---- */

static void find_centre(const struct page_data *data, const struct page_body *body, double centre[3])
{
    const double *const c = data->shapes[body->shape].info.centre_of_mass;
    for (int row = 0; row < 3; row++) {
        const double *const r = body->pose + 4 * row;
        centre[row] = r[0] * c[0] + r[1] * c[1] + r[2] * c[2] + r[3];
    }
}

/* The quaternion x y z w of a row-major [R|T], divided by its largest part (Shepperd 1978, "Quaternion from rotation matrix"). */
static void find_turn(const double pose[12], int16_t turn[4])
{
    const double diagonal[4] = {pose[0], pose[5], pose[10], pose[0] + pose[5] + pose[10]};
    int largest = 3;
    for (int i = 0; i < 3; i++) {
        largest = diagonal[i] > diagonal[largest] ? i : largest;
    }
    double q[4];
    if (largest == 3) {
        q[0] = pose[9] - pose[6];
        q[1] = pose[2] - pose[8];
        q[2] = pose[4] - pose[1];
        q[3] = 1 + diagonal[3];
    } else {
        const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
        q[i] = 1 + diagonal[i] - diagonal[j] - diagonal[k];
        q[j] = pose[4 * i + j] + pose[4 * j + i];
        q[k] = pose[4 * i + k] + pose[4 * k + i];
        q[3] = pose[4 * k + j] - pose[4 * j + k];
    }
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) {
        turn[i] = (int16_t)lround(q[i] / length * PAGE_TURN_SCALE);
    }
}

static int add_move(struct page_data *data, uint32_t body, bool is_there)
{
    struct page_move *const moves = with_room(data->moves, &data->move_capacity, data->move_count + 1, sizeof *data->moves);
    if (!moves) {
        return out_of_memory();
    }
    data->moves = moves;
    struct page_move *const move = &moves[data->move_count++];
    *move = (struct page_move){.body = body, .place = {NAN, NAN, NAN}};
    if (is_there) {
        double centre[3];
        find_centre(data, &data->bodies[body], centre);
        for (int k = 0; k < 3; k++) {
            move->place[k] = (float)(centre[k] - data->origin[k]);
        }
        find_turn(data->bodies[body].pose, move->turn);
    }
    return GOOD;
}

/* The pose at which `pose` places what is at `local`. */
static void place(double placed[12], const double pose[12], const double local[12])
{
    for (int i = 0; i < 12; i++) {
        const double *const row = pose + i / 4 * 4, *const column = local + i % 4;
        placed[i] = row[0] * column[0] + row[1] * column[4] + row[2] * column[8] + (i % 4 == 3 ? row[3] : 0);
    }
}

/* Where a body is: the scene tells it of pieces of objects, which may move, of other bodies it has that of the object. */
static swiftprox_status get_pose(const struct page_data *data, const struct player *player, uint32_t body, double pose[12])
{
    const struct page_body *const asked = &data->bodies[body];
    const swiftprox_object_id id = data->objects[asked->object].id;
    swiftprox_object_info info = {.struct_size = sizeof info};
    const swiftprox_status status = swiftprox_scene_get_object_info(player->scene, id, &info);
    if (status != SWIFTPROX_OK || !(info.ground || info.compound)) {
        return status != SWIFTPROX_OK ? status : swiftprox_scene_get_piece_pose(player->scene, id, asked->piece, pose);
    }
    if (info.compound) {
        place(pose, info.pose, asked->local);
    } else {
        memcpy(pose, info.pose, sizeof info.pose);
    }
    return SWIFTPROX_OK;
}

/* Whether one of the object's bodies is elsewhere is told by all bits of its pose. */
static int see_poses(struct page_data *data, const struct player *player, uint32_t number)
{
    struct page_object *const object = &data->objects[number];
    for (uint32_t piece = 0; piece < object->piece_count; piece++) {
        const uint32_t at = object->first_body + piece;
        double pose[12];
        if (get_pose(data, player, at, pose) != SWIFTPROX_OK) {
            return player_failed();
        }
        if (object->is_there && memcmp(pose, data->bodies[at].pose, sizeof pose) == 0) {
            continue;
        }
        memcpy(data->bodies[at].pose, pose, sizeof pose);
        if (data->has_origin && add_move(data, at, true) != GOOD) {
            return FAILED;
        }
    }
    object->is_there = true;
    object->last_step = data->step_count;
    return GOOD;
}

/* The first step that has bodies says where the page's origin is: floats are finest there. A ground may reach far beyond all
 * others; it counts where there are no others. */
static int place_origin(struct page_data *data)
{
    size_t count = 0;
    for (size_t i = 0; i < data->body_count; i++) {
        count += !data->shapes[data->bodies[i].shape].ground;
    }
    for (size_t i = 0; i < data->body_count; i++) {
        double centre[3];
        find_centre(data, &data->bodies[i], centre);
        const double share = count == 0 ? 1 / (double)data->body_count : 1 / (double)count;
        for (int k = 0; k < 3 && (count == 0 || !data->shapes[data->bodies[i].shape].ground); k++) {
            data->origin[k] += share * centre[k];
        }
    }
    data->has_origin = true;
    int result = GOOD;
    for (size_t i = 0; i < data->body_count && result == GOOD; i++) {
        result = add_move(data, (uint32_t)i, true);
    }
    return result;
}

/* Which bodies have come, moved and gone. */
static int add_moves(struct page_data *data, const struct player *player)
{
    size_t count = 0;
    if (swiftprox_scene_copy_object_ids(player->scene, NULL, 0, &count) != SWIFTPROX_OK) {
        return player_failed();
    }
    swiftprox_object_id *const ids = with_room(data->ids, &data->id_capacity, count, sizeof *data->ids);
    if (!ids) {
        return out_of_memory();
    }
    data->ids = ids;
    if (count > 0 && swiftprox_scene_copy_object_ids(player->scene, ids, count, &count) != SWIFTPROX_OK) {
        return player_failed();
    }
    int result = GOOD;
    for (size_t i = 0; i < count && result == GOOD; i++) {
        uint32_t number;
        result = see_object(data, player, ids[i], &number);
        result = result == GOOD ? see_poses(data, player, number) : result;
    }
    if (result == GOOD && !data->has_origin && data->body_count > 0) {
        result = place_origin(data);
    }
    for (size_t i = 0; i < data->object_count && result == GOOD; i++) {
        struct page_object *const object = &data->objects[i];
        if (object->is_there && object->last_step != data->step_count) {
            object->is_there = false;
            for (uint32_t piece = 0; piece < object->piece_count && result == GOOD; piece++) {
                result = add_move(data, object->first_body + piece, false);
            }
        }
    }
    return result;
}

/* ---- pairs ---- */

static size_t bytes_of_pair(const struct page_pair *pair)
{
    return PAIR_BYTES + (pair->has_points ? POINTS_BYTES : 0) + (size_t)pair->contact_count * CONTACT_BYTES +
           (size_t)pair->line_count * LINE_BYTES;
}

/* A ground that is too large to be drawn has none: the page shows its pairs alone. */
static uint32_t find_body(const struct page_data *data, const struct player *player, swiftprox_object_id id, uint32_t piece)
{
    uint32_t number;
    return id.bits != 0 && player_find_number(player, id, &number) && number < data->object_count &&
                   data->objects[number].first_body != PAGE_NO_BODY && piece < data->objects[number].piece_count
               ? data->objects[number].first_body + piece
               : PAGE_NO_BODY;
}

/* `contact` is null where none was asked for. */
static struct page_pair make_pair(const struct page_data *data, const struct player *player, const swiftprox_pair_result *result,
                                  const swiftprox_contact *contact)
{
    const swiftprox_pair_answer *const answer = &result->answer;
    const bool is_intersecting = answer->outcome == SWIFTPROX_OUTCOME_INTERSECTING;
    const swiftprox_depth_answer *const depth = is_intersecting && contact && !isnan(contact->depth.depth) ? &contact->depth : NULL;
    const swiftprox_feature *const features[2] = {depth ? &depth->feature1 : &answer->feature1,
                                                  depth ? &depth->feature2 : &answer->feature2};
    struct page_pair pair = {
        .bodies = {find_body(data, player, result->object1, result->piece1),
                   find_body(data, player, result->object2, result->piece2)},
        .outcome = (uint8_t)answer->outcome,
        .decided_by = (uint8_t)answer->decided_by,
        .interval = {NAN, NAN, NAN},
    };
    for (int i = 0; i < 2; i++) {
        const uint16_t level = answer->statistics.levels[i];
        pair.levels[i] = (uint8_t)(level < UINT8_MAX ? level : UINT8_MAX);
        pair.features[i] = (uint8_t)features[i]->kind;
        memcpy(pair.feature_ids[i], features[i]->ids, sizeof features[i]->ids);
    }
    if (!is_intersecting) {
        memcpy(pair.interval, (double[3]){answer->distance, answer->lower, answer->upper}, sizeof pair.interval);
    } else if (depth) {
        memcpy(pair.interval, (double[3]){depth->depth, depth->lower, depth->upper}, sizeof pair.interval);
    }
    memcpy(pair.points, depth ? depth->world1 : answer->world1, sizeof answer->world1);
    memcpy(pair.points + 3, depth ? depth->world2 : answer->world2, sizeof answer->world2);
    memcpy(pair.points + 6, depth ? depth->normal : answer->normal, sizeof answer->normal);
    pair.has_points = !isnan(pair.points[0]) || !isnan(pair.points[6]);
    return pair;
}

/* Which of the pairs that a query listed is nearer than which: less than 0 of those that overlap. */
struct nearness {
    double gap;
    size_t index;
};

static int nearer_first(const void *left, const void *right)
{
    const struct nearness *const a = left, *const b = right;
    return a->gap != b->gap ? (a->gap > b->gap) - (a->gap < b->gap) : (a->index > b->index) - (a->index < b->index);
}

static struct nearness *order_pairs(const swiftprox_pair_result *pairs, size_t count, const swiftprox_scene_answer *answer)
{
    struct nearness *const order = malloc((count + 1) * sizeof *order);
    for (size_t i = 0; order && i < count; i++) {
        const bool is_deep = i < answer->contact_count && pairs[i].answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING;
        const double gap = is_deep ? -answer->contacts[i].depth.depth : pairs[i].answer.distance;
        order[i] = (struct nearness){isnan(gap) ? 0 : gap, i};
    }
    if (order) {
        qsort(order, count, sizeof *order, nearer_first);
    }
    return order;
}

static void set_contact(struct page_contact *contact, const struct page_data *data, const swiftprox_manifold_point *point)
{
    for (int k = 0; k < 3; k++) {
        contact->points[0][k] = (float)(point->world1[k] - data->origin[k]);
        contact->points[1][k] = (float)(point->world2[k] - data->origin[k]);
    }
    contact->gap[0] = point->gap_lower;
    contact->gap[1] = point->gap_upper;
}

/* The points of the pair's manifold, and where they go. */
struct found_points {
    struct page_step *step;
    size_t *capacity; /* of the step's contacts */
    const swiftprox_manifold_point *points;
    size_t count;
};

static bool add_contacts(const struct page_data *data, struct page_pair *pair, const struct found_points *found)
{
    struct page_step *const step = found->step;
    pair->contact_count = (uint16_t)(found->count < UINT16_MAX ? found->count : UINT16_MAX);
    if (pair->contact_count == 0) {
        return true;
    }
    struct page_contact *const contacts =
        with_room(step->contacts, found->capacity, step->contact_count + pair->contact_count, sizeof *contacts);
    if (!contacts) {
        return false;
    }
    step->contacts = contacts;
    for (size_t i = 0; i < pair->contact_count; i++) {
        set_contact(&contacts[step->contact_count++], data, &found->points[i]);
    }
    return true;
}

static void swap_points(swiftprox_manifold_point *point)
{
    double world[3];
    memcpy(world, point->world1, sizeof world);
    memcpy(point->world1, point->world2, sizeof world);
    memcpy(point->world2, world, sizeof world);
}

/* The points where a body meets a ground, asked anew: a scene's contact query finds none. Up to the largest gap that is asked of
 * all, or as far as the pair is apart. `points` receives them; 0 where the pair is none with a ground. */
static size_t find_ground_points(const struct page_data *data, const struct player *player, const struct page_pair *pair,
                                 swiftprox_manifold_point points[PAGE_GROUND_POINTS])
{
    const double asked = player->options->max_distance;
    const double least = pair->outcome == SWIFTPROX_OUTCOME_INTERSECTING ? 0 : pair->interval[2];
    const double max_distance = isfinite(asked) && asked > least ? asked : least;
    for (int side = 0; side < 2; side++) {
        const uint32_t on = pair->bodies[side], of = pair->bodies[1 - side];
        if (on == PAGE_NO_BODY || of == PAGE_NO_BODY || !data->shapes[data->bodies[on].shape].ground) {
            continue;
        }
        size_t count = 0;
        const swiftprox_placed body = {data->shapes[data->bodies[of].shape].shape, data->bodies[of].pose};
        const swiftprox_placed_ground ground = {data->shapes[data->bodies[on].shape].ground, data->bodies[on].pose};
        /* Curved bodies have none, which is no failure of the page. */
        if (page_ground_find_points(body, ground, max_distance, points, &count) != SWIFTPROX_OK) {
            return 0;
        }
        for (size_t i = 0; side == 0 && i < count; i++) {
            swap_points(&points[i]);
        }
        return count;
    }
    return 0;
}

/* Of a pair without a contact, such as of a query for distances, none. */
static bool add_points(const struct page_data *data, const struct player *player, struct page_pair *pair,
                       struct found_points found, const swiftprox_contact *contact)
{
    swiftprox_manifold_point of_ground[PAGE_GROUND_POINTS];
    if (contact && contact->manifold.point_count > 0) {
        found.points += contact->first_point;
        found.count = contact->manifold.point_count;
    } else if (contact) {
        found.points = of_ground;
        found.count = find_ground_points(data, player, pair, of_ground);
    }
    return !contact || add_contacts(data, pair, &found);
}

/* Where the lines of a pair's march go. */
struct march {
    const struct page_data *data;
    struct page_step *step;
    struct page_pair *pair;
    size_t *capacity; /* of the step's lines */
    bool has_memory;
};

static void add_line(void *user, swiftprox_draw_kind kind, const double *start, const double *end)
{
    struct march *const march = user;
    struct page_step *const step = march->step;
    if (!march->has_memory || march->pair->line_count == UINT16_MAX) {
        return;
    }
    struct page_line *const lines = with_room(step->lines, march->capacity, step->line_count + 1, sizeof *lines);
    march->has_memory = lines != NULL;
    if (lines) {
        step->lines = lines;
        struct page_line *const line = &lines[step->line_count++];
        march->pair->line_count++;
        line->kind = (uint8_t)kind;
        for (int k = 0; k < 3; k++) {
            line->ends[0][k] = (float)(start[k] - march->data->origin[k]);
            line->ends[1][k] = (float)(end[k] - march->data->origin[k]);
        }
    }
}

/* The march of a pair, asked anew; none of a shape that is in no scene, nor of a ground. */
static bool add_march(struct march *march)
{
    const struct page_data *const data = march->data;
    swiftprox_placed placed[2];
    swiftprox_draw draw = SWIFTPROX_DRAW_DEFAULT;
    draw.kinds = 1u << SWIFTPROX_DRAW_KIND_FEATURE | 1u << SWIFTPROX_DRAW_KIND_MARCH;
    draw.user = march;
    draw.line = add_line;
    for (int i = 0; i < 2; i++) {
        if (march->pair->bodies[i] == PAGE_NO_BODY) {
            return true;
        }
        const struct page_body *const body = &data->bodies[march->pair->bodies[i]];
        placed[i] = (swiftprox_placed){data->shapes[body->shape].shape, body->pose};
        if (!placed[i].shape) {
            return true;
        }
    }
    return swiftprox_pair_draw(placed[0], placed[1], NULL, &draw) == SWIFTPROX_OK && march->has_memory;
}

static void count_pair(struct page_step *step, const swiftprox_pair_answer *answer)
{
    const uint16_t *const levels = answer->statistics.levels;
    const size_t level = levels[0] > levels[1] ? levels[0] : levels[1];
    const size_t decision = (size_t)answer->decided_by;
    step->touching += answer->outcome == SWIFTPROX_OUTCOME_INTERSECTING;
    step->decided[decision < PAGE_DECISIONS ? decision : 0]++;
    step->levels[level < PAGE_LEVELS ? level : PAGE_LEVELS - 1]++;
}

/* What the step's query listed, the deepest and nearest first: of a query that stopped the pair at which it did. */
static int add_pairs(struct page_data *data, const struct player *player, const swiftprox_scene_answer *answer,
                     struct page_step *step)
{
    const swiftprox_pair_result *const pairs = answer->found ? answer->found : answer->pairs;
    step->listed = answer->found ? 1 : answer->count;
    for (size_t i = 0; i < step->listed; i++) {
        count_pair(step, &pairs[i].answer);
    }
    const size_t most = data->most_pairs < LIMIT / PAIR_BYTES ? data->most_pairs : LIMIT / PAIR_BYTES;
    const size_t count = step->listed < most ? step->listed : most;
    size_t capacity = 0, line_capacity = 0;
    struct nearness *const order = order_pairs(pairs, step->listed, answer);
    step->pairs = calloc(count + 1, sizeof *step->pairs);
    bool has_memory = order && step->pairs;
    while (has_memory && step->pair_count < count) {
        const size_t at = order[step->pair_count].index;
        const swiftprox_contact *const contact = at < answer->contact_count ? &answer->contacts[at] : NULL;
        struct page_pair *const pair = &step->pairs[step->pair_count++];
        *pair = make_pair(data, player, &pairs[at], contact);
        const struct found_points found = {step, &capacity, answer->points, 0};
        has_memory = add_points(data, player, pair, found, contact);
        if (has_memory && step->pair_count <= LEAST_PAIRS) {
            struct march march = {data, step, pair, &line_capacity, true};
            has_memory = add_march(&march);
        }
        data->pair_bytes += bytes_of_pair(pair);
    }
    free(order);
    return has_memory ? GOOD : out_of_memory();
}

/* ---- the room for pairs ---- */

/* What all that is not pairs takes. */
static size_t bytes_without_pairs(const struct page_data *data)
{
    size_t bytes = data->move_count * MOVE_BYTES + data->body_count * BODY_BYTES + data->step_count * STEP_BYTES;
    for (size_t i = 0; i < data->shape_count; i++) {
        const swiftprox_shape_info *const info = &data->shapes[i].info;
        bytes += info->vertex_count * VERTEX_BYTES + info->triangle_count * TRIANGLE_BYTES;
    }
    return bytes;
}

/* What pairs take if each step keeps up to `most` of them. */
static size_t bytes_of_pairs(const struct page_data *data, size_t most)
{
    size_t bytes = 0;
    for (size_t i = 0; i < data->step_count; i++) {
        const struct page_step *const step = &data->steps[i];
        for (size_t p = 0; p < step->pair_count && p < most; p++) {
            bytes += bytes_of_pair(&step->pairs[p]);
        }
    }
    return bytes;
}

static void keep_pairs(struct page_step *step, size_t most)
{
    while (step->pair_count > most) {
        step->contact_count -= step->pairs[--step->pair_count].contact_count;
        step->line_count -= step->pairs[step->pair_count].line_count;
    }
    /* What does not get smaller stays as it is. */
    struct page_pair *const pairs = realloc(step->pairs, (step->pair_count + 1) * sizeof *pairs);
    step->pairs = pairs ? pairs : step->pairs;
    struct page_contact *const contacts =
        step->contacts ? realloc(step->contacts, (step->contact_count + 1) * sizeof *contacts) : NULL;
    step->contacts = contacts ? contacts : step->contacts;
}

/* The largest number of pairs a step that fits is found by bisection. Steps that come later only lower it, so that it does not
 * matter when it was found before. */
void page_data_fit(struct page_data *data)
{
    const size_t raw = LIMIT / 4 * 3; /* of base64 */
    const size_t other = bytes_without_pairs(data);
    const size_t room = other < raw ? raw - other : 0;
    if (data->pair_bytes <= room) {
        return;
    }
    size_t fits = LEAST_PAIRS, beyond = LIMIT / PAIR_BYTES + 1;
    while (beyond - fits > 1) {
        const size_t middle = fits + (beyond - fits) / 2;
        *(bytes_of_pairs(data, middle) <= room ? &fits : &beyond) = middle;
    }
    data->most_pairs = fits;
    for (size_t i = 0; i < data->step_count; i++) {
        keep_pairs(&data->steps[i], fits);
    }
    data->pair_bytes = bytes_of_pairs(data, fits);
}

/* ---- steps ---- */

int page_data_add(struct page_data *data, const struct player *player, const swiftprox_scene_answer *answer)
{
    struct page_step *const steps = with_room(data->steps, &data->step_capacity, data->step_count + 1, sizeof *data->steps);
    if (!steps) {
        return out_of_memory();
    }
    data->steps = steps;
    struct page_step *const step = &steps[data->step_count];
    const size_t first_move = data->move_count;
    *step = (struct page_step){.kind = (uint32_t)player_query_kind(player)};
    int result = add_moves(data, player);
    data->step_count++; /* so that what the step holds is given back */
    step->move_count = data->move_count - first_move;
    result = result == GOOD ? add_pairs(data, player, answer, step) : result;
    if (data->pair_bytes > 2 * LIMIT) {
        page_data_fit(data);
    }
    return result;
}
