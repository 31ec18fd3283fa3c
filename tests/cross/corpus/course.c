/* What is done with one problem: solved under an observer, measured, converted, made into paths. */
#include "corpus.h"

enum { MOST_RECORDS = 64, MOST_CONTROLS = 5 * MOST_ELEMENTS + 1, MOST_KNOTS = MOST_CONTROLS + 6 };

minvar_element elements[2 * MOST_ELEMENTS];
minvar_report report;
double workspace[MOST_WORKSPACE];
static minvar_record records[MOST_RECORDS];

problem blank(void) {
    problem data = {.options = minvar_options_defaults()};
    data.options.max_iterations = MOST_ITERATIONS;
    return data;
}

minvar_curve curve_of(const problem *data) {
    minvar_curve curve = minvar_curve_through(data->joints, data->joint_count, data->closed);
    if (data->reference != NULL) {
        curve.reference = data->reference;
        curve.reference_count = minvar_curve_elements_len(&curve, &data->options);
        curve.reference_weight = data->reference_weight;
    }
    if (data->obstacle_count > 0) {
        curve.obstacles = data->obstacles;
        curve.obstacle_count = data->obstacle_count;
    }
    return curve;
}

static void add_record(digest *sum, const minvar_record *record) {
    const double numbers[] = {record->value,    record->predicted, record->actual,
                              record->gradient, record->step,      record->shift};
    add_doubles(sum, numbers, sizeof numbers / sizeof *numbers);
}

typedef struct {
    digest sum;
    size_t calls;
    size_t cancel_at;
} history;

static int32_t observe(void *context, size_t iteration, const minvar_record *record) {
    history *seen = context;
    seen->calls++;
    add_whole(&seen->sum, iteration);
    add_record(&seen->sum, record);
    return iteration == seen->cancel_at;
}

/* The history and the curve of a call that ended with `code`. */
static int told(const history *seen, digest *sum, minvar_code code, const minvar_error *error, size_t kept) {
    add_error(sum, code, error);
    if (code != MINVAR_OK) {
        end("curve", sum, code_word(code));
        return 0;
    }
    add_report(sum, &report);
    add_elements(sum, elements, report.elements);
    end("curve", sum, status_word(report.status));
    digest whole = seen->sum;
    add_whole(&whole, seen->calls);
    for (size_t i = 0; i < kept && i < report.iterations; i++) {
        add_record(&whole, &records[i]);
    }
    end("history", &whole, "ok");
    return 1;
}

/* The memory that a problem takes; 0, with a line that nobody expects, where there is not enough of it. */
static size_t memory(const problem *data, digest *sum) {
    const minvar_curve curve = curve_of(data);
    minvar_error error;
    size_t needed = 0;
    const size_t room = minvar_curve_elements_len(&curve, &data->options);
    const minvar_code code = minvar_curve_workspace_len(&curve, &data->options, &needed, &error);
    add_error(sum, code, &error);
    add_whole(sum, needed);
    add_whole(sum, room);
    if (code == MINVAR_OK && (needed > MOST_WORKSPACE || room > MOST_ELEMENTS)) {
        end("curve", sum, "does-not-fit");
        return 0;
    }
    return code == MINVAR_OK ? needed : MOST_WORKSPACE;
}

/* From the data alone, or from the elements that are there. */
static int attempt(const problem *data, int warm) {
    const minvar_curve curve = curve_of(data);
    digest sum = empty_digest();
    const size_t room = memory(data, &sum);
    if (room == 0) {
        return 0;
    }
    history seen = {empty_digest(), 0, data->cancel_at};
    minvar_error error;
    const minvar_code code =
        warm ? minvar_curve_update(&curve, &data->options, workspace, room, observe, &seen, elements, MOST_ELEMENTS,
                                   &report, &error)
             : minvar_curve_solve(&curve, &data->options, workspace, room, observe, &seen, elements, MOST_ELEMENTS,
                                  records, MOST_RECORDS, &report, &error);
    return told(&seen, &sum, code, &error, warm ? 0 : MOST_RECORDS);
}

int solve(const problem *data) { return attempt(data, 0); }

int update(const problem *data) { return attempt(data, 1); }

static void places(digest *sum, const minvar_figures *figures) {
    minvar_point point = {0};
    minvar_error error;
    for (size_t element = 0; element < report.elements; element++) {
        for (int k = 0; k <= 2; k++) {
            const minvar_code code =
                minvar_point_at(elements, report.elements, element, 0.5 * k, &point, &error);
            add_error(sum, code, &error);
            add_point(sum, &point);
        }
    }
    for (int k = 0; k <= 4; k++) {
        const double s = figures->length * (0.25 * k);
        const minvar_code code = minvar_point_at_length(elements, report.elements, s, &point, &error);
        add_error(sum, code, &error);
        add_point(sum, &point);
    }
    /* From the corners of the box and from its middle. */
    for (int k = 0; k < 3; k++) {
        const double *const low = figures->box_low, *const high = figures->box_high;
        const double share = 0.5 * k;
        const double near[3] = {low[0] + share * (high[0] - low[0]), low[1] + share * (high[1] - low[1]),
                                low[2] + share * (high[2] - low[2])};
        const minvar_code code =
            minvar_closest_point(elements, report.elements, near[0], near[1], near[2], &point, &error);
        add_error(sum, code, &error);
        add_point(sum, &point);
    }
}

static minvar_figures figures;

void measured(void) {
    static double controls[MOST_CONTROLS][3], knots[MOST_KNOTS];
    minvar_error error;
    digest sum = empty_digest();
    figures = (minvar_figures){0};
    minvar_code code = minvar_measure(elements, report.elements, &figures, &error);
    add_error(&sum, code, &error);
    if (code == MINVAR_OK) {
        add_double(&sum, figures.length);
        add_double(&sum, figures.variation);
        add_double(&sum, figures.bending);
        add_point(&sum, &figures.least_curvature);
        add_point(&sum, &figures.largest_curvature);
        add_doubles(&sum, figures.box_low, 3);
        add_doubles(&sum, figures.box_high, 3);
        places(&sum, &figures);
    }
    end("measured", &sum, code_word(code));

    digest converted = empty_digest();
    for (size_t i = 0; i < report.elements; i++) {
        double points[6][3];
        add_error(&converted, minvar_element_bezier(&elements[i], &points, &error), &error);
        for (int row = 0; row < 6; row++) {
            add_doubles(&converted, points[row], 3);
        }
    }
    size_t control_count = 0, knot_count = 0;
    add_error(&converted, minvar_bspline_len(elements, report.elements, &control_count, &knot_count, &error), &error);
    code = minvar_bspline(elements, report.elements, controls, MOST_CONTROLS, knots, MOST_KNOTS, &error);
    add_error(&converted, code, &error);
    if (code == MINVAR_OK) {
        for (size_t i = 0; i < control_count; i++) {
            add_doubles(&converted, controls[i], 3);
        }
        add_doubles(&converted, knots, knot_count);
    }
    end("converted", &converted, code_word(code));
}

static int32_t move(void *context, const minvar_move *step) {
    digest *sum = context;
    add_whole(sum, (uint64_t)(int64_t)step->turn);
    add_doubles(sum, step->end, 3);
    add_doubles(sum, step->centre, 3);
    add_double(sum, step->deviation);
    return 0;
}

static int32_t write(void *context, const char *text, size_t length) {
    digest *sum = context;
    for (size_t i = 0; i < length; i++) {
        add_byte(sum, (unsigned char)text[i]);
    }
    return 0;
}

void paths(void) {
    minvar_error error;
    digest sum = empty_digest();
    /* A power of two of the length; where the chain has none, none can be made into a path either. */
    const double tolerance = figures.length / 128;
    minvar_code code = minvar_chords(elements, report.elements, tolerance, move, &sum, &error);
    add_error(&sum, code, &error);
    end("chords", &sum, code_word(code));

    sum = empty_digest();
    code = minvar_arcs(elements, report.elements, tolerance, move, &sum, &error);
    add_error(&sum, code, &error);
    const int flat = code == MINVAR_OK;
    end("arcs", &sum, code_word(code));

    sum = empty_digest();
    minvar_gcode_options options =
        minvar_gcode_defaults(tolerance, 100 * figures.length, figures.box_high[2] + figures.length);
    options.motion = flat ? MINVAR_ARCS : MINVAR_CHORDS;
    options.plane = (uint32_t)(report.elements % 3);
    options.units = (uint32_t)(report.elements % 2);
    options.decimals = 6 + (uint32_t)(report.iterations % 4);
    options.comments = 1;
    options.depth = -0.25 * figures.length;
    minvar_gcode_summary summary;
    code = minvar_write_gcode(elements, report.elements, &options, write, &sum, &summary, &error);
    add_error(&sum, code, &error);
    if (code == MINVAR_OK) {
        add_whole(&sum, summary.lines);
        add_whole(&sum, summary.arcs);
        add_whole(&sum, summary.chords);
        add_double(&sum, summary.length);
        add_double(&sum, summary.minutes);
        add_double(&sum, summary.deviation);
    }
    end("gcode", &sum, code_word(code));
}

int course(const problem *data, extent how_far) {
    if (!solve(data)) {
        return 0;
    }
    if (how_far >= MEASURE) {
        measured();
    }
    if (how_far >= MAKE_PATHS) {
        paths();
    }
    return 1;
}
