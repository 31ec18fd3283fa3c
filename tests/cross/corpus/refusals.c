/*
 * Every error but those of pointers, with its numbers and its sentence; NaN and infinities wherever a number can be given.
 *
 * MINVAR_NULL_POINTER, MINVAR_MISALIGNED and MINVAR_TOO_LONG depend on the machine's pointers and are not here.
 */
#include "corpus.h"

static const double not_numbers[3] = {0.0 / 0.0, 1.0 / 0.0, -1.0 / 0.0};

static problem good(void) {
    problem data = blank();
    data.joint_count = 4;
    data.joints[0] = minvar_joint_with_tangent(minvar_joint_at(0, 0, 0), MINVAR_FIXED, 1, 0, 0);
    data.joints[1] = minvar_joint_with_tangent(minvar_joint_at(1, 1, 0), MINVAR_INITIAL, 1, 1, 0);
    data.joints[1] = minvar_joint_with_curvature(data.joints[1], MINVAR_INITIAL, 0.125, -0.125, 0);
    data.joints[2] = minvar_joint_at(2, 1, 0);
    data.joints[3] = minvar_joint_at(3, 0, 0);
    return data;
}

static void curves(void) {
    problem data;
#define REFUSED(what, change) \
    do { \
        data = good(); \
        change; \
        begin("refused", what, NULL); \
        solve(&data); \
    } while (0)
    REFUSED("few-joints", data.joint_count = 1);
    REFUSED("closed-few-joints", (data.joint_count = 2, data.closed = 1));
    for (unsigned k = 0; k < 3; k++) {
        data = good();
        data.joints[k].position.value[k] = not_numbers[k];
        begin_number("refused", "position-not-finite", k);
        solve(&data);
        data = good();
        data.joints[1].tangent[k % 2].value[k] = not_numbers[k];
        begin_number("refused", "tangent-not-finite", k);
        solve(&data);
        data = good();
        data.joints[1].curvature[k % 2].value[k] = not_numbers[k];
        begin_number("refused", "curvature-not-finite", k);
        solve(&data);
        /* The value of a free quantity is not read: this solves. */
        data = good();
        data.joints[3].tangent[0].value[k] = not_numbers[k];
        data.joints[2].guide[k] = not_numbers[k];
        begin_number("refused", "not-read", k);
        solve(&data);
    }
    REFUSED("unknown-given", data.joints[2].tangent[0].given = 17);
    REFUSED("unknown-continuity", data.joints[3].continuity = 3);
    REFUSED("coincident", data.joints[2] = data.joints[1]);
    REFUSED("zero-tangent", data.joints[2] = minvar_joint_with_tangent(data.joints[2], MINVAR_FIXED, 0, -0.0, 0));
    REFUSED("not-perpendicular", data.joints[0] = minvar_joint_with_curvature(data.joints[0], MINVAR_FIXED, 1, 1, 0));
    /* The chord is all that tells the direction, and the curvature is along it. */
    REFUSED("needs-tangent",
            (data.joint_count = 2, data.joints[1] = minvar_joint_at(2, 0, 0),
             data.joints[0] = minvar_joint_with_curvature(minvar_joint_at(0, 0, 0), MINVAR_FIXED, 0.5, 0, 0)));
    REFUSED("sides-differ", data.joints[1].tangent[0].given = MINVAR_FIXED);
    REFUSED("no-position", (data.joints[0].position.given = data.joints[1].position.given =
                                data.joints[2].position.given = MINVAR_FREE));
    REFUSED("too-small", (data.joint_count = 2, data.joints[1] = minvar_joint_at(1e-100, 0, 0)));
    REFUSED("too-large", data.joints[3].position.value[1] = 1e100);
    REFUSED("not-planar", (data.joints[3].position.value[2] = 0.125, data.options.dimension = 2));
    REFUSED("zero-guide", data.joints[2] = minvar_joint_on_line(data.joints[2], 2, 1, 0, 0, 0, 0));
    REFUSED("guide-not-finite", data.joints[2] = minvar_joint_on_plane(data.joints[2], 2, 1, 0, 0, not_numbers[0], 1));
    REFUSED("short-length", data.options.length = 3);
    REFUSED("functional", data.options.functional = 6);
    REFUSED("elements", data.options.elements_per_span = 1025);
    REFUSED("points", data.options.quadrature_points = 11);
    REFUSED("dimension", data.options.dimension = 1);
    REFUSED("continuation", data.options.continuation = 17);
    REFUSED("decrease", data.options.relative_decrease = not_numbers[0]);
    REFUSED("tension", data.options.tension = -1);
    REFUSED("tension-si", (data.options.tension = 1, data.options.functional = MINVAR_SI_MVC));
    REFUSED("bending", data.options.bending = not_numbers[1]);
    REFUSED("length", data.options.length = not_numbers[2]);
    REFUSED("tolerance", data.options.tolerance = not_numbers[0]);
    const minvar_obstacle obstacle = {{1, 2, 0}, {2, 2, 0}, 0.25, MINVAR_LEFT};
#define WITH_OBSTACLE(what, change) \
    REFUSED(what, (data.obstacle_count = 1, data.obstacles[0] = obstacle, change))
    WITH_OBSTACLE("obstacle", data.obstacles[0].clearance = not_numbers[0]);
    WITH_OBSTACLE("obstacle-side", data.obstacles[0].side = 2);
    WITH_OBSTACLE("obstacle-and-tolerance", data.options.tolerance = 1e-3);
    WITH_OBSTACLE("obstacle-in-space", data.joints[3].position.value[2] = 1);
    minvar_element reference[3] = {{{{0}}}};
    REFUSED("reference", (data.reference = reference, data.reference_weight = 1));
    REFUSED("reference-weight", (data.reference = reference, data.reference_weight = 2));
#undef WITH_OBSTACLE
#undef REFUSED

    /* Too little memory, and a reference of another length. */
    data = good();
    minvar_curve curve = curve_of(&data);
    minvar_error error;
    digest sum = empty_digest();
    minvar_code code =
        minvar_curve_solve(&curve, &data.options, workspace, 99, NULL, NULL, elements, 3, NULL, 0, &report, &error);
    begin("refused", "workspace", NULL);
    add_error(&sum, code, &error);
    end("curve", &sum, code_word(code));
    sum = empty_digest();
    code = minvar_curve_solve(&curve, &data.options, workspace, MOST_WORKSPACE, NULL, NULL, elements, 2, NULL, 0, &report,
                              &error);
    begin("refused", "room", NULL);
    add_error(&sum, code, &error);
    end("curve", &sum, code_word(code));
    sum = empty_digest();
    curve.reference = reference;
    curve.reference_count = 2;
    code = minvar_curve_solve(&curve, &data.options, workspace, MOST_WORKSPACE, NULL, NULL, elements, 3, NULL, 0, &report,
                              &error);
    begin("refused", "reference-count", NULL);
    add_error(&sum, code, &error);
    end("curve", &sum, code_word(code));
}

/* A chain of three arched elements along x. */
static void arches(minvar_element *chain) {
    for (int i = 0; i < 3; i++) {
        const minvar_element arch = {{{i, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {0, 0.5, 0}, {1, 0, 0}, {i + 1.0, 0, 0}}};
        chain[i] = arch;
    }
    report.elements = 3;
}

static void stretch(minvar_element *chain, double factor) {
    for (int i = 0; i < 3; i++) {
        for (int row = 0; row < 6; row++) {
            chain[i].rows[row][0] *= factor;
        }
    }
}

static int32_t stop(void *context, const char *text, size_t length) {
    (void)text;
    size_t *const taken = context;
    *taken += length;
    return *taken > 200;
}

static int32_t stop_moving(void *context, const minvar_move *step) {
    (void)step;
    size_t *const taken = context;
    return ++*taken == 5;
}

static void chains(void) {
#define CHAIN(what, change) \
    do { \
        arches(elements); \
        change; \
        begin("refused", what, NULL); \
        measured(); \
        paths(); \
    } while (0)
    CHAIN("no-elements", report.elements = 0);
    /* What is not finite is refused, but the Bezier points of an element are what they are: NaN. */
    CHAIN("element-nan", elements[1].rows[2][1] = not_numbers[0]);
    CHAIN("element-infinite", elements[2].rows[5][0] = not_numbers[1]);
    CHAIN("still", (elements[1].rows[4][0] = 0));
    CHAIN("gap", elements[1].rows[0][0] += 0.03125);
    CHAIN("out-of-plane", elements[2].rows[2][2] = 1);
    CHAIN("whole", (void)0);
#undef CHAIN

    arches(elements);
    minvar_point point = {0};
    minvar_error error;
    digest sum = empty_digest();
    static const double outside[5] = {-1e-3, 17, 0.0 / 0.0, 1.0 / 0.0, -1.0 / 0.0};
    minvar_code code = minvar_point_at(elements, 3, 3, 0.5, &point, &error);
    add_error(&sum, code, &error);
    for (int i = 0; i < 5; i++) {
        add_error(&sum, minvar_point_at(elements, 3, 1, outside[i], &point, &error), &error);
        add_error(&sum, minvar_point_at_length(elements, 3, outside[i], &point, &error), &error);
        add_error(&sum, minvar_closest_point(elements, 3, outside[i], 1, outside[4 - i], &point, &error), &error);
        add_point(&sum, &point);
    }
    begin("refused", "outside", NULL);
    end("measured", &sum, code_word(code));

    static double controls[14][3], knots[20];
    sum = empty_digest();
    code = minvar_bspline(elements, 3, controls, 13, knots, 20, &error);
    add_error(&sum, code, &error);
    begin("refused", "controls", NULL);
    end("converted", &sum, code_word(code));
}

static void programs(void) {
    minvar_gcode_options options;
    minvar_error error;
    size_t taken;
#define PROGRAM(what, change) \
    do { \
        arches(elements); \
        options = minvar_gcode_defaults(1e-3, 100, 5); \
        change; \
        digest sum = empty_digest(); \
        taken = 0; \
        const minvar_code code = minvar_write_gcode(elements, 3, &options, stop, &taken, NULL, &error); \
        add_error(&sum, code, &error); \
        add_whole(&sum, taken); \
        begin("refused", what, NULL); \
        end("gcode", &sum, code_word(code)); \
    } while (0)
    PROGRAM("stopped", (void)0);
    PROGRAM("tolerance-nan", options.tolerance = not_numbers[0]);
    PROGRAM("tolerance-fine", options.tolerance = 1e-6);
    PROGRAM("units", options.units = 2);
    PROGRAM("decimals", options.decimals = 5);
    PROGRAM("feed", options.feed = not_numbers[0]);
    PROGRAM("plunge-feed", options.plunge_feed = not_numbers[1]);
    PROGRAM("depth", options.depth = not_numbers[0]);
    PROGRAM("safe-height", options.safe_height = 0);
    PROGRAM("safe-height-nan", options.safe_height = not_numbers[0]);
    PROGRAM("coordinate", (stretch(elements, 1e9), options.tolerance = 1));
#undef PROGRAM

    arches(elements);
    digest sum = empty_digest();
    taken = 0;
    minvar_code code = minvar_chords(elements, 3, 1e-3, stop_moving, &taken, &error);
    add_error(&sum, code, &error);
    begin("refused", "stopped", NULL);
    end("chords", &sum, code_word(code));
    sum = empty_digest();
    code = minvar_arcs(elements, 3, not_numbers[0], stop_moving, &taken, &error);
    add_error(&sum, code, &error);
    begin("refused", "tolerance", NULL);
    end("arcs", &sum, code_word(code));
}

static void regions(void) {
    static const size_t ranges[3][2] = {{1, 0}, {3, 1}, {2, 2}};
    arches(elements);
    elements[0].rows[1][1] = not_numbers[0];
    minvar_error error;
    minvar_code code = MINVAR_OK;
    digest sum = empty_digest();
    for (int i = 0; i < 3; i++) {
        problem data = good();
        code = minvar_region_hold(elements, 3, 0, ranges[i][0], ranges[i][1], data.joints, 3, &error);
        add_error(&sum, code, &error);
    }
    begin("refused", "region", NULL);
    end("held", &sum, code_word(code));
    sum = empty_digest();
    problem data = good();
    code = minvar_region_hold(elements, 3, 0, 1, 1, data.joints, 3, &error);
    add_error(&sum, code, &error);
    begin("refused", "region-beside-nan", NULL);
    end("held", &sum, code_word(code));
}

void refusals(void) {
    curves();
    chains();
    programs();
    regions();
}
