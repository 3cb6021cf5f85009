/* A page of a scene as one HTML file that loads nothing: what tools/page/ holds, and the scene's data in base64. */
#ifndef SWIFTPROX_TOOLS_PAGE_FILE_H
#define SWIFTPROX_TOOLS_PAGE_FILE_H

#include <stddef.h>
#include <stdio.h>

#include "page_data.h"

/* What the page says of itself. */
struct page_title {
    const char *scene; /* the path of what was played */
    double max_distance;  /* SWIFTPROX_DEFAULT_MAX_DISTANCE: the query's own */
    bool cut_off;      /* the recording ended with the program that was recorded */
};

/* Writes the page. Errors of the file are for its owner to look at; of others a message is printed and the status not GOOD. */
int page_file_write(FILE *file, const struct page_data *data, const struct page_title *title);

#endif
