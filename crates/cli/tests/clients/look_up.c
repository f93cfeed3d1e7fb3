/* Looks all quantities of a table up at the displacements and yaws of a file of doubles, in pairs, and writes them as doubles: look_up TABLE IN OUT */
#include "wheelrail_table.h"

int main(int count, char **arguments)
{
    wr_table table;
    double at[2], values[WR_MOST];
    const char *fault = count == 4 ? wr_table_read(&table, arguments[1]) : "look_up TABLE IN OUT";
    FILE *in, *out;
    if (fault) {
        fprintf(stderr, "%s\n", fault);
        return 1;
    }
    in = fopen(arguments[2], "rb");
    out = fopen(arguments[3], "wb");
    if (!in || !out || wr_table_number(&table, "roll_rad", "wheelset") != 0 || wr_table_number(&table, "x", "left") != -1) return 2;
    while (fread(at, sizeof at, 1, in) == 1) {
        int touches = wr_table_at(&table, at[0], at[1], values);
        if (touches == isnan(values[0])) return 3;
        fwrite(values, sizeof *values, (size_t)table.quantities, out);
    }
    fclose(in);
    fclose(out);
    wr_table_free(&table);
    return 0;
}
