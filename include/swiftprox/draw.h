/*
 * swiftprox. Debug drawing: what shapes, pairs and scenes are and what queries did, as lines, points and texts. The conventions are
 * those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_DRAW_H
#define SWIFTPROX_DRAW_H

#include "../swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_draw Debug drawing
 * @{
 */

/** What a line, a point or a text shows. */
typedef enum swiftprox_draw_kind SWIFTPROX_INT32 {
  /**
   * An edge of a shape, each once; a point that a shape is. With a swept radius r: the edges of its faces, moved outwards by r,
   * and circles about the ends of spheres and capsules. Of a ground: the edges of its triangles, each once where two triangles
   * are neighbours.
   */
  SWIFTPROX_DRAW_KIND_EDGE = 0,
  /** An edge of the box around an object of a scene. */
  SWIFTPROX_DRAW_KIND_BOX = 1,
  /** A line between the centres of two pieces whose boxes overlap, as the last query of the scene left them. */
  SWIFTPROX_DRAW_KIND_NEAR_PAIR = 2,
  /** Both witness points, and the line from that of object 2 to that of object 1; the text is the distance, or minus the depth. */
  SWIFTPROX_DRAW_KIND_WITNESS = 3,
  /** The normal, from the middle between the witness points on. */
  SWIFTPROX_DRAW_KIND_NORMAL = 4,
  /** Both points of a contact point, and the line from object 2 to object 1; the text is the gap. */
  SWIFTPROX_DRAW_KIND_CONTACT = 5,
  /** A feature at which a march was: a point, an edge, or the sides of a face. */
  SWIFTPROX_DRAW_KIND_FEATURE = 6,
  /**
   * The line between the nearest points of two features at which a march was, from object 2 to object 1; of a face the foot on
   * its plane. The text is the step's number and both features.
   */
  SWIFTPROX_DRAW_KIND_MARCH = 7,
  /**
   * The triangles of the polytope that encloses the origin in the Minkowski difference of overlapping objects, three lines each;
   * the origin, and the nearest point of the boundary. Places are differences, of a point of object 1 minus one of object 2.
   */
  SWIFTPROX_DRAW_KIND_POLYTOPE = 8
} swiftprox_draw_kind;

/** Receives a line. `start` and `end` have 3 numbers, valid during the call; `user` is the pointer of swiftprox_draw. */
typedef void (*swiftprox_draw_line_callback)(void *user,
                                             swiftprox_draw_kind kind,
                                             const double *start,
                                             const double *end);

/** Receives a point of 3 numbers, valid during the call. */
typedef void (*swiftprox_draw_point_callback)(void *user, swiftprox_draw_kind kind, const double *place);

/** Receives a text and its place of 3 numbers, both valid during the call. */
typedef void (*swiftprox_draw_text_callback)(void *user,
                                             swiftprox_draw_kind kind,
                                             const double *place,
                                             const char *text);

/**
 * Who receives what is drawn. Initialise with SWIFTPROX_DRAW_DEFAULT. Callbacks run in the calling thread, during the call. They
 * must return; a C++ exception that leaves one ends the program. They may call the library, but not change the drawn scene.
 */
typedef struct swiftprox_draw {
  /** Set by SWIFTPROX_DRAW_DEFAULT. */
  size_t struct_size;
  /** Which kinds are drawn, and searched for: kind k if bit 1 << k is set. Default: UINT32_MAX, all. */
  uint32_t kinds;
  /** The length of a drawn normal. Default: 1. */
  double normal_length;
  /** Passed to each callback. Default: null. */
  void *user;
  /** Receives lines. Default: null, nobody does. */
  swiftprox_draw_line_callback line;
  /** Receives points. Default: null, nobody does. */
  swiftprox_draw_point_callback point;
  /** Receives texts. Default: null, nobody does. */
  swiftprox_draw_text_callback text;
} swiftprox_draw;

/** Begins a swiftprox_draw: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_DRAW_DEFAULT {sizeof(swiftprox_draw), UINT32_MAX, 1, 0, 0, 0, 0}

/**
 * Draws the edges of a shape, for debugging.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_draw(struct swiftprox_placed object, const struct swiftprox_draw *draw);

/**
 * Draws what a query does, for debugging: both shapes; each step of the march; witness points and normal of the signed distance;
 * the points of the manifold; the polytope of overlapping objects. docs/tools.md has a table.
 *
 * The queries are run anew, cold; `config` is that of swiftprox_pair_manifold. The march is that of swiftprox_pair_distance with
 * SWIFTPROX_LEVELS_NONE. March and polytope are those of the polyhedra over which radii are swept. Small bodies, whose depth is
 * searched by all facets, are drawn with a polytope, too. One of more than 56 vertices is replaced by that of a search to 1 % or
 * 10 %.
 *
 * Same errors as swiftprox_pair_manifold; nothing is drawn then.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_draw(struct swiftprox_placed object1,
                                     struct swiftprox_placed object2,
                                     const struct swiftprox_manifold_config *config,
                                     const struct swiftprox_draw *draw);

/**
 * Draws a scene, for debugging: edges and boxes of its objects, the pairs that its last query found near, and the results that it
 * listed, each with what the query gave: witness points, normal, points of the manifold. Results stay where they were found, even
 * if objects have moved since. Grounds are drawn as all their triangles, one edge after the other.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_draw(const struct swiftprox_scene *scene,
                                      const struct swiftprox_draw *draw);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
