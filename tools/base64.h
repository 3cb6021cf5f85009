/* Numbers as bytes, the lowest first, and bytes as base64 (RFC 4648). All between base64_start and base64_end is one text. */
#ifndef SWIFTPROX_TOOLS_BASE64_H
#define SWIFTPROX_TOOLS_BASE64_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct base64 {
    FILE *file; /* its errors are for its owner to look at */
    unsigned char bytes[3];
    size_t count;
};

struct base64 base64_start(FILE *file);

void base64_add_8(struct base64 *text, uint8_t number);
void base64_add_16(struct base64 *text, uint16_t number);
void base64_add_32(struct base64 *text, uint32_t number);
void base64_add_float(struct base64 *text, float number);
void base64_add_double(struct base64 *text, double number);

void base64_end(struct base64 *text);

#endif
