#include "page_file.h"
#include <swiftprox/geometry.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base64.h"
#include "page_template.h"
#include "program.h"

/* Strings of JSON within a script of HTML: no `<` may stand there. */
static void write_string(FILE *file, const char *text)
{
    fputc('"', file);
    for (const char *at = text; *at; at++) {
        const unsigned char letter = (unsigned char)*at;
        if (letter < ' ' || strchr("\"\\<", letter)) {
            fprintf(file, "\\u%04x", letter);
        } else {
            fputc(letter, file);
        }
    }
    fputc('"', file);
}

static void write_point(FILE *file, const double point[3])
{
    fprintf(file, "[%.17g,%.17g,%.17g]", point[0], point[1], point[2]);
}

/* What is not in arrays. JSON knows no infinity. */
static void write_head(FILE *file, const struct page_data *data, const struct page_title *title)
{
    fputs("<script type=\"application/json\" id=\"head\">{\"version\":", file);
    write_string(file, swiftprox_library_version());
    fputs(",\"scene\":", file);
    const char *const slash = strrchr(title->scene, '/');
    write_string(file, slash ? slash + 1 : title->scene); /* a page that is passed on says nothing of folders */
    if (isfinite(title->max_distance) && title->max_distance >= 0) {
        fprintf(file, ",\"maxDistance\":%.17g", title->max_distance);
    }
    fprintf(file, ",\"cutOff\":%s,\"origin\":", title->cut_off ? "true" : "false");
    write_point(file, data->origin);
    fprintf(file, ",\"turnScale\":%d,\"shapes\":[", PAGE_TURN_SCALE);
    for (size_t i = 0; i < data->shape_count; i++) {
        const swiftprox_shape_info *const info = &data->shapes[i].info;
        fprintf(file, "%s{\"vertices\":%zu,\"triangles\":%zu,\"isGround\":%s,\"radius\":%.17g,\"centre\":", i ? "," : "",
                info->vertex_count, info->triangle_count, data->shapes[i].ground ? "true" : "false", info->radius);
        write_point(file, info->centre_of_mass);
        fputc('}', file);
    }
    fputs("]}</script>\n", file);
}

/* ---- arrays: tools/page/recording.js reads them by these names ---- */

static struct base64 start_block(FILE *file, const char *name)
{
    fprintf(file, "<script type=\"text/plain\" id=\"%s\">", name);
    return base64_start(file);
}

static void end_block(struct base64 *block)
{
    base64_end(block);
    fputs("</script>\n", block->file);
}

/* Vertices seen from the centre of mass, and after them all triangles. */
static int write_shapes(FILE *file, const struct page_data *data)
{
    size_t most = 1;
    for (size_t i = 0; i < data->shape_count; i++) {
        const swiftprox_shape_info *const info = &data->shapes[i].info;
        if (data->shapes[i].ground) {
            continue; /* it is read part by part */
        }
        most = info->vertex_count > most ? info->vertex_count : most;
        most = info->triangle_count > most ? info->triangle_count : most;
    }
    double(*const vertices)[3] = malloc(most * sizeof *vertices);
    uint32_t(*const triangles)[3] = malloc(most * sizeof *triangles);
    swiftprox_status status = vertices && triangles ? SWIFTPROX_OK : SWIFTPROX_ERROR_MEMORY;
    struct base64 block = start_block(file, "shape.vertices");
    for (size_t i = 0; i < data->shape_count && status == SWIFTPROX_OK; i++) {
        const swiftprox_shape_info *const info = &data->shapes[i].info;
        if (data->shapes[i].ground) {
            status = page_ground_write_vertices(data->shapes[i].ground, info, &block);
            continue;
        }
        status = swiftprox_shape_copy_vertices(data->shapes[i].shape, vertices[0], NULL, most);
        for (size_t v = 0; v < info->vertex_count; v++) {
            for (int k = 0; k < 3; k++) {
                base64_add_float(&block, (float)(vertices[v][k] - info->centre_of_mass[k]));
            }
        }
    }
    end_block(&block);
    block = start_block(file, "shape.triangles");
    for (size_t i = 0; i < data->shape_count && status == SWIFTPROX_OK; i++) {
        if (data->shapes[i].ground) {
            status = page_ground_write_triangles(data->shapes[i].ground, &block);
            continue;
        }
        status = swiftprox_shape_copy_triangles(data->shapes[i].shape, triangles[0], most);
        for (size_t t = 0; t < data->shapes[i].info.triangle_count; t++) {
            for (int k = 0; k < 3; k++) {
                base64_add_32(&block, triangles[t][k]);
            }
        }
    }
    end_block(&block);
    const bool has_memory = status != SWIFTPROX_ERROR_MEMORY;
    free(vertices);
    free(triangles);
    if (!has_memory) {
        fputs("swiftprox-replay: no memory for the page\n", stderr);
    }
    return status == SWIFTPROX_OK ? GOOD : has_memory ? player_failed() : FAILED;
}

static void write_bodies(FILE *file, const struct page_data *data)
{
    struct base64 block = start_block(file, "bodies");
    for (size_t i = 0; i < data->body_count; i++) {
        const struct page_body *const body = &data->bodies[i];
        base64_add_32(&block, body->object);
        base64_add_32(&block, body->piece);
        base64_add_32(&block, body->shape);
        base64_add_32(&block, body->fixed);
    }
    end_block(&block);
}

static void write_moves(FILE *file, const struct page_data *data)
{
    struct base64 block = start_block(file, "move.bodies");
    for (size_t i = 0; i < data->move_count; i++) {
        base64_add_32(&block, data->moves[i].body);
    }
    end_block(&block);
    block = start_block(file, "move.places");
    for (size_t i = 0; i < data->move_count; i++) {
        for (int k = 0; k < 3; k++) {
            base64_add_float(&block, data->moves[i].place[k]);
        }
    }
    end_block(&block);
    block = start_block(file, "move.turns");
    for (size_t i = 0; i < data->move_count; i++) {
        for (int k = 0; k < 4; k++) {
            base64_add_16(&block, (uint16_t)data->moves[i].turn[k]);
        }
    }
    end_block(&block);
}

static void write_steps(FILE *file, const struct page_data *data)
{
    struct base64 block = start_block(file, "steps");
    for (size_t i = 0; i < data->step_count; i++) {
        const struct page_step *const step = &data->steps[i];
        base64_add_32(&block, step->kind);
        base64_add_32(&block, (uint32_t)step->move_count);
        base64_add_32(&block, (uint32_t)step->pair_count);
        base64_add_32(&block, (uint32_t)step->listed);
        base64_add_32(&block, (uint32_t)step->touching);
        for (int k = 0; k < PAGE_DECISIONS; k++) {
            base64_add_32(&block, step->decided[k]);
        }
        for (int k = 0; k < PAGE_LEVELS; k++) {
            base64_add_32(&block, step->levels[k]);
        }
    }
    end_block(&block);
}

/* ---- arrays of pairs ---- */

static void add_bodies(struct base64 *block, const struct page_pair *pair)
{
    base64_add_32(block, pair->bodies[0]);
    base64_add_32(block, pair->bodies[1]);
}

static void add_codes(struct base64 *block, const struct page_pair *pair)
{
    base64_add_8(block, pair->outcome);
    base64_add_8(block, pair->decided_by);
    base64_add_8(block, pair->levels[0]);
    base64_add_8(block, pair->levels[1]);
    base64_add_8(block, pair->features[0]);
    base64_add_8(block, pair->features[1]);
    base64_add_8(block, pair->has_points);
    base64_add_16(block, pair->contact_count);
    base64_add_16(block, pair->line_count);
}

static void add_interval(struct base64 *block, const struct page_pair *pair)
{
    for (int k = 0; k < 3; k++) {
        base64_add_double(block, pair->interval[k]);
    }
}

static void add_points(struct base64 *block, const struct page_pair *pair)
{
    for (int k = 0; k < 9 && pair->has_points; k++) {
        base64_add_double(block, pair->points[k]);
    }
}

static void add_features(struct base64 *block, const struct page_pair *pair)
{
    for (int k = 0; k < 4 && pair->has_points; k++) {
        base64_add_32(block, pair->feature_ids[k / 2][k % 2]);
    }
}

static void write_pairs(FILE *file, const struct page_data *data, const char *name,
                        void (*add)(struct base64 *, const struct page_pair *))
{
    struct base64 block = start_block(file, name);
    for (size_t i = 0; i < data->step_count; i++) {
        for (size_t p = 0; p < data->steps[i].pair_count; p++) {
            add(&block, &data->steps[i].pairs[p]);
        }
    }
    end_block(&block);
}

static void write_contacts(FILE *file, const struct page_data *data)
{
    struct base64 block = start_block(file, "contact.points");
    for (size_t i = 0; i < data->step_count; i++) {
        for (size_t c = 0; c < data->steps[i].contact_count; c++) {
            for (int k = 0; k < 6; k++) {
                base64_add_float(&block, data->steps[i].contacts[c].points[k / 3][k % 3]);
            }
        }
    }
    end_block(&block);
    block = start_block(file, "contact.gaps");
    for (size_t i = 0; i < data->step_count; i++) {
        for (size_t c = 0; c < data->steps[i].contact_count; c++) {
            base64_add_double(&block, data->steps[i].contacts[c].gap[0]);
            base64_add_double(&block, data->steps[i].contacts[c].gap[1]);
        }
    }
    end_block(&block);
}

static void write_marches(FILE *file, const struct page_data *data)
{
    struct base64 block = start_block(file, "march.kinds");
    for (size_t i = 0; i < data->step_count; i++) {
        for (size_t l = 0; l < data->steps[i].line_count; l++) {
            base64_add_8(&block, data->steps[i].lines[l].kind);
        }
    }
    end_block(&block);
    block = start_block(file, "march.lines");
    for (size_t i = 0; i < data->step_count; i++) {
        for (size_t l = 0; l < data->steps[i].line_count; l++) {
            for (int k = 0; k < 6; k++) {
                base64_add_float(&block, data->steps[i].lines[l].ends[k / 3][k % 3]);
            }
        }
    }
    end_block(&block);
}

int page_file_write(FILE *file, const struct page_data *data, const struct page_title *title)
{
    fwrite(PAGE_HEAD, 1, sizeof PAGE_HEAD, file);
    write_head(file, data, title);
    const int result = write_shapes(file, data);
    write_bodies(file, data);
    write_moves(file, data);
    write_steps(file, data);
    write_pairs(file, data, "pair.bodies", add_bodies);
    write_pairs(file, data, "pair.codes", add_codes);
    write_pairs(file, data, "pair.intervals", add_interval);
    write_pairs(file, data, "pair.points", add_points);
    write_pairs(file, data, "pair.features", add_features);
    write_contacts(file, data);
    write_marches(file, data);
    fwrite(PAGE_TAIL, 1, sizeof PAGE_TAIL, file);
    return result;
}
