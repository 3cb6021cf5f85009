/*
 * Settings of programs written for SWIFT 1.x or SWIFT++, over swiftprox.
 *
 * All translation units of a program define the same of these, as they had to of old: they change inline functions.
 *
 *   SWIFT_USE_FLOAT         SWIFT_Real is float, else double. Queries compute in double either way.
 *   SWIFT_HIERARCHY         the levels that min_tri_count and qslim_tri_ratio ask for are built where either is not its default.
 *                           Levels that the caller gives need no switch.
 *   SWIFT_ONLY_TRIS and SWIFT_REPORT_EDGE_IDS, both: an edge is reported by one id, 3 * face + k, else by its two vertices.
 *   SWIFT_ALLOW_BOUNDARY    Add_General_Object takes surfaces that are not closed.
 *   SWIFT_DEBUG             warnings about calls without effect are printed, too.
 *   SWIFT_LEGACY_VERSION    1: only the forms of SWIFT 1.x of the two queries that have two, 2: only those of SWIFT++. Not defined:
 *                           both, side by side. Needed where a fifth argument NULL or nullptr of Query_Contact_Determination
 *                           could be of either. With 2, Query_Exact_Distance leaves out pairs at exactly the tolerance, as SWIFT++
 *                           does.
 *   SWIFT_LEGACY_STRICT     meshes are convex up to 1e-6 of their diagonal and counter-clockwise from outside, or refused: else
 *                           what the precision of their coordinates excuses is taken, and a mesh that is inside out is turned.
 *   SWIFT_LEGACY_QUIET      nothing is printed.
 *   SWIFT_LEGACY_MIN_MAX    SWIFT.h defines the macros min and max of SWIFT 1.x, where there are none.
 *   SWIFT_LEGACY_ALL_PAIRS  queries with the tolerance SWIFT_INFINITY list all pairs also where the broad phase is on, else those
 *                           whose boxes overlap.
 *
 * All other switches of old (look-up tables, QSlim, caching, front tracking, priority directions) change nothing.
 */
#ifndef SWIFT_CONFIG_H
#define SWIFT_CONFIG_H

#ifndef SWIFT_MAX_VALENCE
#define SWIFT_MAX_VALENCE 100
#endif

#ifndef SWIFTPP_VERSION1_1_02
#define SWIFTPP_VERSION1_1_02
#endif

#ifndef SWIFT_LEGACY_VERSION
#define SWIFT_LEGACY_VERSION 0
#endif

#endif
