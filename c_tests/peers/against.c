/* Against the peers that this program is linked with:  against_... EXACT_ORACLE */
#include <stdio.h>
#include <string.h>

#include "comparison.h"

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: %s EXACT_ORACLE\n", argv[0]);
        return 2;
    }
    const char *slash = strrchr(argv[0], '/');
    return compare(slash ? slash + 1 : argv[0], argv[1], all_peers, all_peer_count);
}
