/* Reads contact tables, `table.wrp` of `wheelrail table`, and looks contact up in them. C99, one header, no library but libm.
 *
 *     wr_table table;
 *     const char *fault = wr_table_read(&table, "table.wrp");      NULL, or what is wrong
 *     int radius = wr_table_number(&table, "rolling_radius_mm", "right");
 *     double values[WR_MOST];
 *     if (wr_table_at(&table, 2.5, 0.002, values)) use(values[radius]);
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

enum { WR_COEFFICIENTS = 9, WR_YAW_COEFFICIENTS = 5, WR_MOST = 64, WR_MOST_CELLS = 1000000 };

typedef struct {
    char name[19];
    char side[9];     /* "wheelset", "left", "right" */
    int needs;        /* 0 contact, 1 curvatures, 2 ellipse */
    double tolerance; /* in the unit of the quantity */
    double error;     /* largest error, in the unit of the quantity */
} wr_quantity;

typedef struct {
    double yaw[2];   /* rad: the cell lies between them */
    int curve[2];    /* numbers from 0 of the curves at which it begins and ends */
    int touches;     /* 0: a wheel is off its rail */
    int begins;      /* 0 smoothly, 1 at a joint, 2 at a hop, 3 at an edge */
    int lacks[2];    /* left, right: 0 nothing, 1 ellipse, 2 curvatures */
} wr_cell;

typedef struct {
    int kind;                       /* 0 smooth, 1 joint, 2 hop, 3 edge */
    double yaw[2];                  /* rad */
    double c[WR_YAW_COEFFICIENTS];  /* mm: lateral displacement over u, from -1 to 1 between the yaws */
} wr_curve;

typedef struct {
    int part[2];  /* below, above: n > 0 is fork n, n < 0 is cell -n, counted from 1 */
    int curve;    /* counted from 1; 0 where a yaw divides */
    double yaw;   /* rad */
} wr_fork;

typedef struct {
    int cells, quantities, curves, forks;
    int yaw_powers;         /* 1 under one yaw, 5 over a range */
    double from, to;        /* lateral displacement, mm */
    double yaw[2];          /* rad; equal under one yaw */
    double radius, tolerance, beside_curves;
    wr_quantity *quantity;
    wr_cell *cell;
    wr_curve *curve;
    wr_fork *fork;
    double *coefficients; /* [cell][yaw power][power][quantity] */
} wr_table;

static void wr_table_free(wr_table *table)
{
    free(table->quantity);
    free(table->cell);
    free(table->curve);
    free(table->fork);
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

/* Reads the curves and forks of a table over yaw. */
static const char *wr_table_tree_(wr_table *table, FILE *file)
{
    char line[128];
    int k, side;
    for (k = 0; k < table->curves; k++) {
        wr_curve *curve = &table->curve[k];
        if (!fgets(line, sizeof line, file) || sscanf(line, "%8d", &curve->kind) != 1 || !wr_numbers_(line, 8, 2, curve->yaw))
            return "no curve";
        if (!fgets(line, sizeof line, file) || !wr_numbers_(line, 0, 3, curve->c)) return "no coefficients of a curve";
        if (!fgets(line, sizeof line, file) || !wr_numbers_(line, 0, 2, curve->c + 3)) return "no coefficients of a curve";
    }
    for (k = 0; k < table->forks; k++) {
        wr_fork *fork = &table->fork[k];
        if (!fgets(line, sizeof line, file) || !wr_numbers_(line, 24, 1, &fork->yaw) ||
            sscanf(line, "%8d%8d%8d", &fork->part[0], &fork->part[1], &fork->curve) != 3)
            return "no fork";
        if (fork->curve < 0 || fork->curve > table->curves) return "a fork at an unknown curve";
        for (side = 0; side < 2; side++) { /* parts of a fork come behind it, so that every way ends */
            int part = fork->part[side];
            if (part == 0 || part > table->forks || -part > table->cells || (part > 0 && part <= k + 1)) return "a fork to nowhere";
        }
    }
    return NULL;
}

/* Makes the forks between cells in a row, which the curves with the number of each begin: from..to. Returns the number of the part. */
static int wr_table_row_(wr_table *table, int from, int to)
{
    int middle = from + (to - from) / 2, number = ++table->forks;
    wr_fork *fork = &table->fork[number - 1];
    if (to - from == 1) {
        table->forks--;
        return -(from + 1);
    }
    fork->curve = middle + 1;
    fork->part[0] = wr_table_row_(table, from, middle);
    fork->part[1] = wr_table_row_(table, middle, to);
    return number;
}

static const char *wr_table_rest_(wr_table *table, FILE *file)
{
    char line[128];
    const char *fault;
    int version, comments, coefficients, yaw_powers, k, c, q, i, over_yaw;
    double three[3], before;
    if (!fgets(line, sizeof line, file) || sscanf(line, "WRTABLE %d mm", &version) != 1 || version < 1 || version > 2)
        return "not version 1 or 2 of a table in mm";
    over_yaw = version == 2;
    if (!fgets(line, sizeof line, file) || sscanf(line, "%d", &comments) != 1) return "no number of comments";
    for (k = 0; k < comments; k++)
        if (!fgets(line, sizeof line, file)) return "cut off in the comments";
    if (!fgets(line, sizeof line, file) || sscanf(line, "%8d%8d%8d", &table->cells, &table->quantities, &coefficients) != 3)
        return "no sizes";
    yaw_powers = WR_YAW_COEFFICIENTS;
    if (over_yaw && sscanf(line + 24, "%8d%8d%8d", &yaw_powers, &table->curves, &table->forks) != 3) return "no sizes";
    if (table->cells < 1 || table->cells > WR_MOST_CELLS || table->quantities < 1 || table->quantities > WR_MOST ||
        table->curves < 0 || table->curves > WR_MOST_CELLS || table->forks < 0 || table->forks > WR_MOST_CELLS ||
        coefficients != WR_COEFFICIENTS || yaw_powers != WR_YAW_COEFFICIENTS)
        return "sizes beyond those of the grammar";
    if (!over_yaw) table->curves = table->cells + 1;
    table->yaw_powers = over_yaw ? WR_YAW_COEFFICIENTS : 1;
    if (!fgets(line, sizeof line, file) || !wr_numbers_(line, 0, 2, three)) return "no range";
    table->from = three[0];
    table->to = three[1];
    if (over_yaw && (!fgets(line, sizeof line, file) || !wr_numbers_(line, 0, 2, table->yaw))) return "no range of yaws";
    if (!fgets(line, sizeof line, file) || !wr_numbers_(line, 0, 3, three)) return "no radius and tolerance";
    if (!over_yaw) table->yaw[0] = table->yaw[1] = three[0];
    table->radius = three[over_yaw ? 0 : 1];
    table->tolerance = three[over_yaw ? 1 : 2];
    table->beside_curves = over_yaw ? three[2] : 1e-9;
    table->quantity = calloc((size_t)table->quantities, sizeof *table->quantity);
    table->cell = calloc((size_t)table->cells, sizeof *table->cell);
    table->curve = calloc((size_t)table->curves, sizeof *table->curve);
    table->fork = calloc((size_t)(over_yaw ? table->forks + 1 : table->cells), sizeof *table->fork);
    table->coefficients = malloc((size_t)table->cells * (size_t)table->yaw_powers * WR_COEFFICIENTS * (size_t)table->quantities *
                                 sizeof *table->coefficients);
    if (!table->quantity || !table->cell || !table->curve || !table->fork || !table->coefficients) return "not enough memory";
    for (q = 0; q < table->quantities; q++) {
        wr_quantity *quantity = &table->quantity[q];
        if (!fgets(line, sizeof line, file) || strlen(line) < 79 || !wr_numbers_(line, 29, 2, three)) return "no quantity";
        wr_word_(line, 0, 18, quantity->name);
        wr_word_(line, 21, 8, quantity->side);
        if (sscanf(line + 18, "%2d", &quantity->needs) != 1) return "a quantity without its needs";
        quantity->tolerance = three[0];
        quantity->error = three[1];
    }
    if (over_yaw && (fault = wr_table_tree_(table, file))) return fault;
    before = table->from;
    for (c = 0; c < table->cells; c++) {
        wr_cell *cell = &table->cell[c];
        if (!fgets(line, sizeof line, file) || !wr_numbers_(line, over_yaw ? 24 : 8, 2, three) ||
            sscanf(line, "%2d%2d%2d%2d", &cell->touches, &cell->begins, &cell->lacks[0], &cell->lacks[1]) != 4)
            return "no cell";
        if (over_yaw) {
            cell->yaw[0] = three[0];
            cell->yaw[1] = three[1];
            if (sscanf(line + 8, "%8d%8d", &cell->curve[0], &cell->curve[1]) != 2) return "a cell without curves";
            for (k = 0; k < 2; k++)
                if (--cell->curve[k] < 0 || cell->curve[k] >= table->curves) return "a cell at an unknown curve";
        } else {
            if (three[0] < before || three[1] < three[0]) return "cells out of order";
            before = three[1];
            for (k = 0; k < 2; k++) cell->curve[k] = c + k;
            table->curve[c].c[0] = three[0];
            table->curve[c].kind = cell->begins;
            table->curve[c + 1].c[0] = three[1];
            table->curve[c + 1].kind = 3;
        }
        for (q = 0; q < table->quantities; q++) {
            const wr_quantity *quantity = &table->quantity[q];
            int lacks = *quantity->side == 'w' ? 0 : cell->lacks[*quantity->side == 'r'];
            int exists = cell->touches && quantity->needs + lacks <= 2;
            double *own = table->coefficients + ((size_t)c * (size_t)table->yaw_powers * WR_COEFFICIENTS) * (size_t)table->quantities;
            for (k = 0; k < table->yaw_powers * WR_COEFFICIENTS; k += 3) {
                if (cell->touches && (!fgets(line, sizeof line, file) || !wr_numbers_(line, 0, 3, three)))
                    return "no coefficients";
                for (i = 0; i < 3; i++) own[(k + i) * table->quantities + q] = exists ? three[i] : (double)NAN;
            }
        }
    }
    if (!over_yaw) wr_table_row_(table, 0, table->cells);
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

/* Where a value is between two others: -1 to 1; 0 if they are equal or out of order. */
static double wr_share_(const double *ends, double value)
{
    return ends[1] > ends[0] ? ((value - ends[0]) - (ends[1] - value)) / (ends[1] - ends[0]) : 0.0;
}

static double wr_curve_at_(const wr_curve *curve, double yaw)
{
    double u = wr_share_(curve->yaw, yaw), y = curve->c[WR_YAW_COEFFICIENTS - 1];
    int j;
    for (j = WR_YAW_COEFFICIENTS - 2; j >= 0; j--) y = y * u + curve->c[j];
    return y;
}

/* Gives all quantities at a lateral displacement, mm, and a yaw, rad; NaN for what does not exist and outside the range. Returns 1 where
 * both wheels touch, otherwise 0. A table under one yaw has that yaw only. */
static int wr_table_at(const wr_table *table, double lateral, double yaw, double *values)
{
    const wr_cell *cell;
    const double *rows;
    double ends[2], t, u, sums[WR_COEFFICIENTS * WR_MOST];
    int part = table->forks > 0 ? 1 : -1, count = table->quantities, row = WR_COEFFICIENTS * count, j, k, q;
    if (!(lateral >= table->from && lateral <= table->to && yaw >= table->yaw[0] && yaw <= table->yaw[1])) {
        for (q = 0; q < count; q++) values[q] = (double)NAN;
        return 0;
    }
    while (part > 0) {
        const wr_fork *fork = &table->fork[part - 1];
        int above = fork->curve > 0 ? lateral >= wr_curve_at_(&table->curve[fork->curve - 1], yaw) : yaw >= fork->yaw;
        part = fork->part[above];
    }
    cell = &table->cell[-part - 1];
    for (k = 0; k < 2; k++) ends[k] = wr_curve_at_(&table->curve[cell->curve[k]], yaw);
    t = wr_share_(ends, lateral);
    t = t < -1.0 ? -1.0 : t > 1.0 ? 1.0 : t;
    u = wr_share_(cell->yaw, yaw);
    rows = table->coefficients + (size_t)(-part - 1) * (size_t)table->yaw_powers * (size_t)row;
    for (k = 0; k < row; k++) sums[k] = rows[(table->yaw_powers - 1) * row + k];
    for (j = table->yaw_powers - 2; j >= 0; j--)
        for (k = 0; k < row; k++) sums[k] = sums[k] * u + rows[j * row + k];
    for (q = 0; q < count; q++) values[q] = sums[(WR_COEFFICIENTS - 1) * count + q];
    for (k = WR_COEFFICIENTS - 2; k >= 0; k--)
        for (q = 0; q < count; q++) values[q] = values[q] * t + sums[k * count + q];
    return cell->touches;
}

#endif
