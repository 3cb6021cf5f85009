/* What a page of a scene shows (tools/page/): its shapes, where its bodies are in each step, and what its pairs were answered.
 *
 * A body is a convex piece of an object or of its compound, or a ground. Bodies are drawn, so that their places are rounded: see
 * struct page_move. What is said of pairs are the doubles of the answers. */
#ifndef SWIFTPROX_TOOLS_PAGE_DATA_H
#define SWIFTPROX_TOOLS_PAGE_DATA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <swiftprox.h>

#include "page_ground.h"
#include "player.h"

/* Stands for the body of an object that is in no scene. */
#define PAGE_NO_BODY UINT32_MAX

/* Answers are counted by what decided them, and by the coarser of their two levels; the last level is for all beyond, too. */
enum { PAGE_DECISIONS = 9, PAGE_LEVELS = 8 };

struct page_shape {
    const swiftprox_shape *shape;   /* a share; null of a ground */
    const swiftprox_ground *ground; /* a share; null of a shape */
    swiftprox_shape_info info;      /* of a ground what page_ground_measure sets */
};

struct page_body {
    uint32_t object; /* numbered as swiftprox-replay prints it */
    uint32_t piece;
    uint32_t shape;
    bool fixed;       /* when it was first seen */
    double local[12]; /* of a compound's piece: its pose in the compound */
    double pose[12];  /* the last that was seen */
};

struct page_object {
    swiftprox_object_id id;
    uint32_t first_body; /* PAGE_NO_BODY: never seen */
    uint32_t piece_count;
    bool is_there;
    size_t last_step; /* in which it was there */
};

/* A body that stands elsewhere than in the step before. */
struct page_move {
    uint32_t body;
    float place[3];  /* of its shape's centre of mass, seen from the page's origin; NaN: it is gone */
    int16_t turn[4]; /* x y z w of its unit quaternion, times PAGE_TURN_SCALE */
};

#define PAGE_TURN_SCALE 32767

/* An answer, as swiftprox_pair_answer and, of an intersecting pair, swiftprox_depth_answer say it. */
struct page_pair {
    uint32_t bodies[2];
    uint8_t outcome, decided_by, levels[2], features[2];
    bool has_points;
    uint16_t contact_count;
    uint16_t line_count; /* of its march */
    double interval[3]; /* distance, lower, upper; of an intersecting pair depth, lower, upper, or NaN */
    double points[9];   /* witness points in the world frame and the normal */
    uint32_t feature_ids[2][2];
};

/* A point of a manifold. */
struct page_contact {
    float points[2][3]; /* in the world frame, seen from the page's origin: they are drawn */
    double gap[2];      /* its lower and upper end */
};

/* A line of a march, as swiftprox_pair_draw draws it. */
struct page_line {
    uint8_t kind;
    float ends[2][3]; /* in the world frame, seen from the page's origin */
};

struct page_step {
    size_t move_count;
    size_t listed; /* pairs that the query listed */
    size_t touching;
    uint32_t kind; /* swiftprox_query_kind */
    uint32_t decided[PAGE_DECISIONS];
    uint32_t levels[PAGE_LEVELS];
    size_t pair_count; /* pairs that are kept: the deepest and nearest, in that order */
    struct page_pair *pairs;
    size_t contact_count;
    struct page_contact *contacts; /* of all kept pairs */
    size_t line_count;
    struct page_line *lines; /* of the first kept pairs */
};

struct page_data {
    bool has_origin;
    double origin[3]; /* the mean of the bodies' centres in the first step that has some */
    size_t shape_count, shape_capacity;
    struct page_shape *shapes;
    size_t body_count, body_capacity;
    struct page_body *bodies;
    size_t object_count, object_capacity;
    struct page_object *objects; /* by number */
    size_t move_count, move_capacity;
    struct page_move *moves;
    size_t step_count, step_capacity;
    struct page_step *steps;
    size_t pair_bytes;        /* in the page, of all pairs that are kept */
    size_t most_pairs;        /* that a step may keep */
    swiftprox_object_id *ids; /* room for those of a step */
    size_t id_capacity;
};

/* Nothing yet. */
struct page_data page_data_start(void);

void page_data_free(struct page_data *data);

/* Takes in the step that was just played. GOOD, or a message and another status. */
int page_data_add(struct page_data *data, const struct player *player, const swiftprox_scene_answer *answer);

/* Keeps of each step only as many pairs as a page has room for: when all steps are in. */
void page_data_fit(struct page_data *data);

#endif
