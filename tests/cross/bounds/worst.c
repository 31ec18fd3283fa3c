/*
 * What every function takes at most over the whole corpus: the linker puts the functions here before the library's
 * (`--wrap`), each measures its call. Lines of fields between semicolons, which scripts/cross/bounds.sh makes into tables:
 *
 *     stack;FUNCTION;calls;bytes;instructions;the case with the deepest stack
 *     solve;FUNCTION;FUNCTIONAL;planar|space;elements;iterations;linearisations;instructions;the case    (every solve)
 */
#include "corpus/corpus.h"
#include "platform/decimal.h"
#include "platform/meter.h"
#include "platform/platform.h"

enum function {
    ELEMENTS_LEN, WORKSPACE_LEN, SOLVE_CURVE, UPDATE, MINIMA, REGION_HOLD, MEASURE_CHAIN, POINT_AT, POINT_AT_LENGTH,
    CLOSEST_POINT, BEZIER, BSPLINE_LEN, BSPLINE, CHORDS, ARCS, WRITE_GCODE, FUNCTIONS
};

static const char *const names[FUNCTIONS] = {
    "minvar_curve_elements_len", "minvar_curve_workspace_len", "minvar_curve_solve",   "minvar_curve_update",
    "minvar_curve_minima",       "minvar_region_hold",         "minvar_measure",       "minvar_point_at",
    "minvar_point_at_length",    "minvar_closest_point",       "minvar_element_bezier", "minvar_bspline_len",
    "minvar_bspline",            "minvar_chords",              "minvar_arcs",          "minvar_write_gcode"};

static struct {
    unsigned calls;
    reading most;
    char where[96];
    int is_new;
} seen[FUNCTIONS];

static void note(enum function which, reading read) {
    seen[which].calls++;
    if (read.stack > seen[which].most.stack) {
        seen[which].most.stack = read.stack;
        seen[which].is_new = 1;
    }
    if (read.instructions > seen[which].most.instructions) {
        seen[which].most.instructions = read.instructions;
    }
}

static void text(const char *words) { platform_print(words); }

static void number(uint64_t value) {
    char room[24];
    text(";");
    text(decimal(value, room));
}

/* The solves of the case that is being computed: its name comes with its first line. */
enum { MOST_WAITING = 4 };
static struct {
    enum function which;
    uint32_t functional;
    minvar_report report;
    uint64_t instructions;
} waiting[MOST_WAITING];
static int waiting_count;

static void solved(enum function which, minvar_code code, const minvar_options *options, const minvar_report *of,
                   reading read) {
    note(which, read);
    if (code == MINVAR_OK && waiting_count < MOST_WAITING) {
        waiting[waiting_count].which = which;
        waiting[waiting_count].functional = options->functional;
        waiting[waiting_count].report = *of;
        waiting[waiting_count].instructions = read.instructions;
        waiting_count++;
    }
}

#define MEASURED(which, call) \
    meter_start(); \
    const minvar_code code = call; \
    const reading read = meter_stop();

#define WRAP(which, name, parameters, arguments) \
    minvar_code __real_##name parameters; \
    minvar_code __wrap_##name parameters; \
    minvar_code __wrap_##name parameters { \
        MEASURED(which, __real_##name arguments) \
        note(which, read); \
        return code; \
    }

#define CHAIN const minvar_element *chain, size_t count

WRAP(WORKSPACE_LEN, minvar_curve_workspace_len,
     (const minvar_curve *curve, const minvar_options *options, size_t *len, minvar_error *error),
     (curve, options, len, error))
WRAP(REGION_HOLD, minvar_region_hold,
     (CHAIN, int32_t closed, size_t first, size_t region, minvar_joint *joints, size_t joint_count, minvar_error *error),
     (chain, count, closed, first, region, joints, joint_count, error))
WRAP(MEASURE_CHAIN, minvar_measure, (CHAIN, minvar_figures *figures, minvar_error *error), (chain, count, figures, error))
WRAP(POINT_AT, minvar_point_at, (CHAIN, size_t element, double t, minvar_point *point, minvar_error *error),
     (chain, count, element, t, point, error))
WRAP(POINT_AT_LENGTH, minvar_point_at_length, (CHAIN, double s, minvar_point *point, minvar_error *error),
     (chain, count, s, point, error))
WRAP(CLOSEST_POINT, minvar_closest_point, (CHAIN, double x, double y, double z, minvar_point *point, minvar_error *error),
     (chain, count, x, y, z, point, error))
WRAP(BEZIER, minvar_element_bezier, (const minvar_element *element, double (*points)[6][3], minvar_error *error),
     (element, points, error))
WRAP(BSPLINE_LEN, minvar_bspline_len, (CHAIN, size_t *controls, size_t *knots, minvar_error *error),
     (chain, count, controls, knots, error))
WRAP(BSPLINE, minvar_bspline,
     (CHAIN, double (*controls)[3], size_t controls_len, double *knots, size_t knots_len, minvar_error *error),
     (chain, count, controls, controls_len, knots, knots_len, error))
WRAP(CHORDS, minvar_chords, (CHAIN, double tolerance, minvar_visitor visit, void *context, minvar_error *error),
     (chain, count, tolerance, visit, context, error))
WRAP(ARCS, minvar_arcs, (CHAIN, double tolerance, minvar_visitor visit, void *context, minvar_error *error),
     (chain, count, tolerance, visit, context, error))
WRAP(WRITE_GCODE, minvar_write_gcode,
     (CHAIN, const minvar_gcode_options *options, minvar_writer write, void *context, minvar_gcode_summary *summary,
      minvar_error *error),
     (chain, count, options, write, context, summary, error))

size_t __real_minvar_curve_elements_len(const minvar_curve *curve, const minvar_options *options);
size_t __wrap_minvar_curve_elements_len(const minvar_curve *curve, const minvar_options *options);
size_t __wrap_minvar_curve_elements_len(const minvar_curve *curve, const minvar_options *options) {
    meter_start();
    const size_t length = __real_minvar_curve_elements_len(curve, options);
    note(ELEMENTS_LEN, meter_stop());
    return length;
}

#define MEMORY double *memory, size_t memory_len, minvar_observer observer, void *context

#define WRAP_SOLVE(which, name, parameters, arguments) \
    minvar_code __real_##name parameters; \
    minvar_code __wrap_##name parameters; \
    minvar_code __wrap_##name parameters { \
        MEASURED(which, __real_##name arguments) \
        solved(which, code, options, found, read); \
        return code; \
    }

WRAP_SOLVE(SOLVE_CURVE, minvar_curve_solve,
           (const minvar_curve *curve, const minvar_options *options, MEMORY, minvar_element *out, size_t out_len,
            minvar_record *records, size_t records_len, minvar_report *found, minvar_error *error),
           (curve, options, memory, memory_len, observer, context, out, out_len, records, records_len, found, error))
WRAP_SOLVE(UPDATE, minvar_curve_update,
           (const minvar_curve *curve, const minvar_options *options, MEMORY, minvar_element *out, size_t out_len,
            minvar_report *found, minvar_error *error),
           (curve, options, memory, memory_len, observer, context, out, out_len, found, error))
WRAP(MINIMA, minvar_curve_minima,
     (const minvar_curve *curve, const minvar_options *options, MEMORY, minvar_element *out, size_t out_len,
      minvar_report *reports, size_t reports_len, size_t *found, minvar_error *error),
     (curve, options, memory, memory_len, observer, context, out, out_len, reports, reports_len, found, error))

static void listen(const char *name, uint64_t hash, const char *outcome) {
    static const char *const words[] = {"MVC", "MEC", "SI-MVC", "SI-MEC", "space MVC", "space MEC"};
    (void)hash;
    for (int i = 0; i < waiting_count; i++) {
        const minvar_report *const of = &waiting[i].report;
        text("solve;");
        text(names[waiting[i].which]);
        text(";");
        text(words[waiting[i].functional]);
        text(of->planar ? ";planar" : ";space");
        number(of->elements);
        number(of->iterations);
        number(of->linearisations);
        number(waiting[i].instructions);
        text(";");
        text(name);
        text(";");
        text(outcome);
        text("\n");
    }
    waiting_count = 0;
    for (int which = 0; which < FUNCTIONS; which++) {
        if (seen[which].is_new) {
            size_t i = 0;
            for (; name[i] != '\0' && i + 1 < sizeof seen[which].where; i++) {
                seen[which].where[i] = name[i];
            }
            seen[which].where[i] = '\0';
            seen[which].is_new = 0;
        }
    }
}

int main(void) {
    corpus(listen, WITH_LONG);
    for (int which = 0; which < FUNCTIONS; which++) {
        text("stack;");
        text(names[which]);
        number(seen[which].calls);
        number(seen[which].most.stack);
        number(seen[which].most.instructions);
        text(";");
        text(seen[which].where);
        text("\n");
    }
    return 0;
}
