#include "base64.h"

#include <string.h>

struct base64 base64_start(FILE *file)
{
    return (struct base64){.file = file};
}

/* Three bytes as four letters, the last `3 - count` of which are padding. */
static void put(struct base64 *text)
{
    static const char LETTERS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint32_t bits = (uint32_t)text->bytes[0] << 16 | (uint32_t)text->bytes[1] << 8 | text->bytes[2];
    char letters[4];
    for (size_t i = 0; i < sizeof letters; i++) {
        letters[i] = i <= text->count ? LETTERS[bits >> (18 - 6 * i) & 63] : '=';
    }
    fwrite(letters, 1, sizeof letters, text->file);
    memset(text->bytes, 0, sizeof text->bytes);
    text->count = 0;
}

void base64_add_8(struct base64 *text, uint8_t number)
{
    text->bytes[text->count++] = number;
    if (text->count == sizeof text->bytes) {
        put(text);
    }
}

void base64_add_16(struct base64 *text, uint16_t number)
{
    base64_add_8(text, (uint8_t)(number & 0xff));
    base64_add_8(text, (uint8_t)(number >> 8));
}

void base64_add_32(struct base64 *text, uint32_t number)
{
    base64_add_16(text, (uint16_t)(number & 0xffff));
    base64_add_16(text, (uint16_t)(number >> 16));
}

void base64_add_float(struct base64 *text, float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    base64_add_32(text, bits);
}

void base64_add_double(struct base64 *text, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    base64_add_32(text, (uint32_t)(bits & UINT32_MAX));
    base64_add_32(text, (uint32_t)(bits >> 32));
}

void base64_end(struct base64 *text)
{
    if (text->count > 0) {
        put(text);
    }
}
