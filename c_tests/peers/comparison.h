/* Compares the library with its peers on all scenes. Every peer runs in a child process, so that it may crash or never end; the
 * next child goes on behind the pose that did it. Where a peer and the library differ, the exact oracle decides. */
#ifndef COMPARISON_H
#define COMPARISON_H

#include "peers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Runs everything and prints a table; the exit status of the program. `oracle`: the path of the oracle program. */
int compare(const char *program, const char *oracle, const struct peer *peers, size_t peer_count);

#ifdef __cplusplus
}
#endif

#endif
