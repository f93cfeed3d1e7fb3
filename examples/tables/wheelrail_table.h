/* Reads contact tables, `table.wrp` of `wheelrail table`, and looks contact up in them. C99, one header, no library but libm.
 *
 *     wr_table table;
 *     const char *fault = wr_table_read(&table, "table.wrp");      NULL, or what is wrong
 *     int radius = wr_table_number(&table, "rolling_radius_mm", "right");
 *     double values[WR_MOST];
 *     if (wr_table_at(&table, 2.5, values)) use(values[radius]);
 *     wr_table_free(&table);
 *
 * Lengths in mm, angles in rad; see the comments at the head of each table. Numbers are read by strtod: keep the locale "C".
 */
#ifndef WHEELRAIL_TABLE_H
#define WHEELRAIL_TABLE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WR_COEFFICIENTS = 9, WR_MOST = 64, WR_MOST_CELLS = 1000000 };

typedef struct {
    char name[19];
    char side[9];     /* "wheelset", "left", "right" */
    int needs;        /* 0 contact, 1 curvatures, 2 ellipse */
    double tolerance; /* in the unit of the quantity */
    double error;     /* largest error, in the unit of the quantity */
} wr_quantity;

typedef struct {
    double from, to; /* lateral displacement, mm */
    int touches;     /* 0: a wheel is off its rail */
    int begins;      /* 0 smoothly, 1 at a joint, 2 at a hop, 3 at an edge */
    int lacks[2];    /* left, right: 0 nothing, 1 ellipse, 2 curvatures */
} wr_cell;

typedef struct {
    int cells, quantities;
    double from, to, yaw, radius, tolerance;
    wr_quantity *quantity;
    wr_cell *cell;
    double *coefficients; /* [cell][power][quantity] */
} wr_table;

static void wr_table_free(wr_table *table)
{
    free(table->quantity);
    free(table->cell);
    free(table->coefficients);
    memset(table, 0, sizeof *table);
}

/* Reads numbers of 25 columns from a column on; 0 if one is missing. */
static int wr_numbers_(const char *line, int from, int count, double *out)
{
    int k;
    if ((int)strlen(line) < from + 25 * count) return 0;
    for (k = 0; k < count; k++) {
        char field[26], *end;
        memcpy(field, line + from + 25 * k, 25);
        field[25] = 0;
        out[k] = strtod(field, &end);
        if (end == field || *end) return 0;
    }
    return 1;
}

static void wr_word_(const char *line, int from, int width, char *out)
{
    memcpy(out, line + from, (size_t)width);
    while (width > 0 && out[width - 1] == ' ') width--;
    out[width] = 0;
}

static const char *wr_table_rest_(wr_table *table, FILE *file)
{
    char line[128];
    int comments, coefficients, k, c, q, i;
    double three[3];
    if (!fgets(line, sizeof line, file) || strncmp(line, "WRTABLE    1 mm", 15)) return "not version 1 of a table in mm";
    if (!fgets(line, sizeof line, file) || sscanf(line, "%d", &comments) != 1) return "no number of comments";
    for (k = 0; k < comments; k++)
        if (!fgets(line, sizeof line, file)) return "cut off in the comments";
    if (!fgets(line, sizeof line, file) || sscanf(line, "%d%d%d", &table->cells, &table->quantities, &coefficients) != 3)
        return "no sizes";
    if (table->cells < 1 || table->cells > WR_MOST_CELLS || table->quantities < 1 || table->quantities > WR_MOST ||
        coefficients != WR_COEFFICIENTS)
        return "sizes beyond those of version 1";
    if (!fgets(line, sizeof line, file) || !wr_numbers_(line, 0, 2, three)) return "no range";
    table->from = three[0];
    table->to = three[1];
    if (!fgets(line, sizeof line, file) || !wr_numbers_(line, 0, 3, three)) return "no yaw, radius and tolerance";
    table->yaw = three[0];
    table->radius = three[1];
    table->tolerance = three[2];
    table->quantity = calloc((size_t)table->quantities, sizeof *table->quantity);
    table->cell = calloc((size_t)table->cells, sizeof *table->cell);
    table->coefficients =
        malloc((size_t)table->cells * WR_COEFFICIENTS * (size_t)table->quantities * sizeof *table->coefficients);
    if (!table->quantity || !table->cell || !table->coefficients) return "not enough memory";
    for (q = 0; q < table->quantities; q++) {
        wr_quantity *quantity = &table->quantity[q];
        if (!fgets(line, sizeof line, file) || strlen(line) < 79 || !wr_numbers_(line, 29, 2, three)) return "no quantity";
        wr_word_(line, 0, 18, quantity->name);
        wr_word_(line, 21, 8, quantity->side);
        if (sscanf(line + 18, "%2d", &quantity->needs) != 1) return "a quantity without its needs";
        quantity->tolerance = three[0];
        quantity->error = three[1];
    }
    for (c = 0; c < table->cells; c++) {
        wr_cell *cell = &table->cell[c];
        double *own = table->coefficients + (size_t)c * WR_COEFFICIENTS * (size_t)table->quantities;
        if (!fgets(line, sizeof line, file) || !wr_numbers_(line, 8, 2, three) ||
            sscanf(line, "%2d%2d%2d%2d", &cell->touches, &cell->begins, &cell->lacks[0], &cell->lacks[1]) != 4)
            return "no cell";
        cell->from = three[0];
        cell->to = three[1];
        if (c > 0 && cell->from < table->cell[c - 1].to) return "cells out of order";
        for (q = 0; q < table->quantities; q++) {
            const wr_quantity *quantity = &table->quantity[q];
            int lacks = *quantity->side == 'w' ? 0 : cell->lacks[*quantity->side == 'r'];
            int exists = cell->touches && quantity->needs + lacks <= 2;
            for (k = 0; k < WR_COEFFICIENTS; k += 3) {
                if (cell->touches && (!fgets(line, sizeof line, file) || !wr_numbers_(line, 0, 3, three)))
                    return "no coefficients";
                for (i = 0; i < 3; i++) own[(k + i) * table->quantities + q] = exists ? three[i] : (double)NAN;
            }
        }
    }
    if (!fgets(line, sizeof line, file) || strncmp(line, "END", 3)) return "no END line: the file was cut off";
    return NULL;
}

/* Reads a table. Returns NULL, or what is wrong; nothing is to be freed then. */
static const char *wr_table_read(wr_table *table, const char *path)
{
    const char *fault;
    FILE *file = fopen(path, "r");
    memset(table, 0, sizeof *table);
    if (!file) return "the file cannot be opened";
    fault = wr_table_rest_(table, file);
    fclose(file);
    if (fault) wr_table_free(table);
    return fault;
}

/* Returns the number of a quantity of "wheelset", "left" or "right"; -1 of an unknown one. */
static int wr_table_number(const wr_table *table, const char *name, const char *side)
{
    int q;
    for (q = 0; q < table->quantities; q++)
        if (!strcmp(table->quantity[q].name, name) && !strcmp(table->quantity[q].side, side)) return q;
    return -1;
}

/* Gives all quantities at a lateral displacement, mm; NaN for what does not exist. Returns 1 where both wheels touch, otherwise 0. */
static int wr_table_at(const wr_table *table, double lateral, double *values)
{
    const wr_cell *cell;
    const double *row;
    double t;
    int low = 0, high = table->cells - 1, k, q;
    if (!(lateral >= table->from && lateral <= table->to)) {
        for (q = 0; q < table->quantities; q++) values[q] = (double)NAN;
        return 0;
    }
    while (low < high) { /* the last cell that begins at or before the displacement */
        int middle = (low + high + 1) / 2;
        if (table->cell[middle].from <= lateral) low = middle;
        else high = middle - 1;
    }
    cell = &table->cell[low];
    t = cell->to > cell->from ? ((lateral - cell->from) - (cell->to - lateral)) / (cell->to - cell->from) : 0.0;
    row = table->coefficients + ((size_t)low * WR_COEFFICIENTS + WR_COEFFICIENTS - 1) * (size_t)table->quantities;
    for (q = 0; q < table->quantities; q++) values[q] = row[q];
    for (k = WR_COEFFICIENTS - 2; k >= 0; k--) {
        row -= table->quantities;
        for (q = 0; q < table->quantities; q++) values[q] = values[q] * t + row[q];
    }
    return cell->touches;
}

#endif
