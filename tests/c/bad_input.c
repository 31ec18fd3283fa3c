/* Every error of the interface, each provoked on purpose: the right code and numbers, a sentence that names the culprit,
 * results untouched, and all the same without an error struct. */
#include "check.h"

#include <stddef.h>
#include <stdlib.h>

/* Outputs that no refused call may touch. */
static struct {
    unsigned char *bytes;
    size_t size;
} watched[8];
static size_t watched_count;

enum { PATTERN = 0xA5 };

static void watch(void *place, size_t size) {
    watched[watched_count].bytes = place;
    watched[watched_count].size = size;
    watched_count++;
}

static void fill(void) {
    for (size_t i = 0; i < watched_count; i++) {
        memset(watched[i].bytes, PATTERN, watched[i].size);
    }
}

static int untouched(void) {
    for (size_t i = 0; i < watched_count; i++) {
        for (size_t k = 0; k < watched[i].size; k++) {
            if (watched[i].bytes[k] != PATTERN) {
                return 0;
            }
        }
    }
    return 1;
}

static int refusals;
static int seen[128];

static void judge(const char *file, int line, const char *what, minvar_code code, minvar_code wanted,
                  const minvar_error *error, const char *word) {
    int wrong = code != wanted || !untouched();
    if (error != NULL) {
        wrong = wrong || error->code != wanted || memchr(error->message, '\0', sizeof error->message) == NULL ||
                strstr(error->message, word) == NULL;
    }
    if (wrong) {
        failures++;
        printf("%s:%d: %s: code %d, wanted %d%s; message \"%.192s\", wanted the word \"%s\"\n", file, line, what,
               (int)code, (int)wanted, untouched() ? "" : "; a result was touched",
               error != NULL ? error->message : "(no error struct)", error != NULL ? word : "");
    }
    seen[wanted] = 1;
    refusals++;
}

static minvar_error last;

/* `call` mentions `e`, the error: once a struct, then NULL. */
#define REFUSED(call, wanted, word) \
    do { \
        minvar_error *e = &last; \
        memset(&last, PATTERN, sizeof last); \
        fill(); \
        judge(__FILE__, __LINE__, #call, (call), (wanted), &last, (word)); \
        e = NULL; \
        fill(); \
        judge(__FILE__, __LINE__, #call, (call), (wanted), NULL, ""); \
        e = (minvar_error *)(void *)(1 + (char *)misplaced); \
        fill(); \
        judge(__FILE__, __LINE__, #call " with a misaligned error", (call), MINVAR_MISALIGNED, NULL, ""); \
    } while (0)

/* Room for a misaligned anything. */
static max_align_t misplaced[256];
#define MISALIGNED(type) ((type *)(void *)(1 + (char *)misplaced))

static const size_t TOO_LONG = SIZE_MAX / 2;

/* Every way in which the pointer `name` of a call can be wrong; `call` mentions it. */
#define POINTER(type, name, call, word) \
    do { \
        type *const kept_ = name; \
        name = NULL; \
        REFUSED(call, MINVAR_NULL_POINTER, word); \
        name = MISALIGNED(type); \
        REFUSED(call, MINVAR_MISALIGNED, word); \
        name = kept_; \
    } while (0)

/* ... and the length of an array. */
#define ARRAY(type, name, length, call, word) \
    do { \
        POINTER(type, name, call, word); \
        const size_t length_ = length; \
        length = TOO_LONG; \
        REFUSED(call, MINVAR_TOO_LONG, word); \
        length = length_; \
    } while (0)

static const double BAD[3] = {NAN, INFINITY, -INFINITY};

/* ---- the curve functions ---- */

static minvar_joint joints[4];
static minvar_curve data = {.joints = joints, .joint_count = 4};
static minvar_options options_data;
static const minvar_curve *curve = &data;
static const minvar_options *options = &options_data;
static double workspace_room[20000];
static double *workspace = workspace_room;
static size_t workspace_len = 20000;
static minvar_element elements_room[8];
static minvar_element *elements = elements_room;
static size_t elements_len = 8;
static minvar_record records_room[8];
static minvar_record *records = records_room;
static size_t records_len = 8;
static minvar_report report_room;
static minvar_report *report = &report_room;
static size_t len_room;
static size_t *len = &len_room;

#define SOLVE \
    minvar_curve_solve(curve, options, workspace, workspace_len, NULL, NULL, elements, elements_len, records, \
                       records_len, report, e)
#define WORKSPACE_LEN minvar_curve_workspace_len(curve, options, len, e)

static void reset(void) {
    joints[0] = minvar_joint_with_tangent(minvar_joint_at(0, 0, 0), MINVAR_FIXED, 1, 0, 0);
    joints[1] = minvar_joint_with_curvature(
        minvar_joint_with_tangent(minvar_joint_at(1, 1, 0), MINVAR_INITIAL, 1, 1, 0), MINVAR_INITIAL, 0.1, -0.1, 0);
    joints[2] = minvar_joint_at(2, 1, 0);
    joints[3] = minvar_joint_at(3, 0, 0);
    data = minvar_curve_through(joints, 4, 0);
    options_data = minvar_options_defaults();
    workspace_len = 20000;
    elements_len = 8;
}

#define REFUSED_CURVE(wanted, at, word) \
    do { \
        REFUSED(WORKSPACE_LEN, wanted, word); \
        CHECK(last.index == 0 || last.index == (at)); \
        REFUSED(SOLVE, wanted, word); \
        if (last.index != (at)) { \
            failures++; \
            printf("%s:%d: index %zu, wanted %zu\n", __FILE__, __LINE__, last.index, (size_t)(at)); \
        } \
        reset(); \
    } while (0)

static void curve_functions(void) {
    watched_count = 0;
    watch(elements_room, sizeof elements_room);
    watch(records_room, sizeof records_room);
    watch(&report_room, sizeof report_room);
    watch(&len_room, sizeof len_room);
    reset();

    POINTER(const minvar_curve, curve, SOLVE, "curve");
    POINTER(const minvar_options, options, SOLVE, "options");
    ARRAY(double, workspace, workspace_len, SOLVE, "workspace");
    ARRAY(minvar_element, elements, elements_len, SOLVE, "elements");
    ARRAY(minvar_record, records, records_len, SOLVE, "records");
    POINTER(minvar_report, report, SOLVE, "report");
    ARRAY(const minvar_joint, data.joints, data.joint_count, SOLVE, "curve->joints");
    POINTER(const minvar_curve, curve, WORKSPACE_LEN, "curve");
    POINTER(const minvar_options, options, WORKSPACE_LEN, "options");
    POINTER(size_t, len, WORKSPACE_LEN, "len");
    ARRAY(const minvar_joint, data.joints, data.joint_count, WORKSPACE_LEN, "curve->joints");

    CHECK(minvar_curve_elements_len(curve, options) == 3);
    CHECK(minvar_curve_elements_len(NULL, options) == 0);
    CHECK(minvar_curve_elements_len(curve, NULL) == 0);
    CHECK(minvar_curve_elements_len(MISALIGNED(minvar_curve), options) == 0);
    data.joints = NULL;
    CHECK(minvar_curve_elements_len(curve, options) == 0);
    reset();
    data.closed = 1;
    CHECK(minvar_curve_elements_len(curve, options) == 4);
    data.joint_count = 0;
    CHECK(minvar_curve_elements_len(curve, options) == 0);
    reset();

    data.joint_count = 1;
    REFUSED(SOLVE, MINVAR_TOO_FEW_JOINTS, "1");
    CHECK(last.needed == 2 && last.given == 1);
    REFUSED_CURVE(MINVAR_TOO_FEW_JOINTS, 0, "two joints");
    data.joints = NULL;
    data.joint_count = 0;
    REFUSED_CURVE(MINVAR_TOO_FEW_JOINTS, 0, "two joints");
    data.closed = 1;
    data.joint_count = 2;
    REFUSED(SOLVE, MINVAR_CLOSED_TOO_FEW_JOINTS, "2");
    CHECK(last.needed == 3 && last.given == 2);
    REFUSED_CURVE(MINVAR_CLOSED_TOO_FEW_JOINTS, 0, "three joints");

    /* Every number of a joint, each way in which it can be no number; a free quantity's is not read. */
    for (int bad = 0; bad < 3; bad++) {
        for (int d = 0; d < 3; d++) {
            joints[2].position.value[d] = BAD[bad];
            REFUSED_CURVE(MINVAR_JOINT_NOT_FINITE, 2, "position of joint 2");
            for (int side = 0; side < 2; side++) {
                joints[1].tangent[side].value[d] = BAD[bad];
                REFUSED_CURVE(MINVAR_JOINT_NOT_FINITE, 1, "tangent of joint 1");
                joints[1].curvature[side].value[d] = BAD[bad];
                REFUSED_CURVE(MINVAR_JOINT_NOT_FINITE, 1, "curvature of joint 1");
                joints[3].tangent[side].value[d] = BAD[bad];
                joints[3].curvature[side].value[d] = BAD[bad];
            }
            WORKS(WORKSPACE_LEN);
            reset();
        }
    }

    static const uint32_t unknown[2] = {6, UINT32_MAX};
    for (int i = 0; i < 2; i++) {
        joints[3].continuity = unknown[i];
        REFUSED_CURVE(MINVAR_UNKNOWN_CODE, 3, "continuity of joint 3");
        joints[2].position.given = unknown[i];
        REFUSED_CURVE(MINVAR_UNKNOWN_CODE, 2, "position of joint 2");
        for (int side = 0; side < 2; side++) {
            joints[2].tangent[side].given = unknown[i];
            REFUSED_CURVE(MINVAR_UNKNOWN_CODE, 2, "tangent of joint 2");
            joints[2].curvature[side].given = unknown[i];
            REFUSED_CURVE(MINVAR_UNKNOWN_CODE, 2, "curvature of joint 2");
        }
    }

    joints[2] = joints[1];
    REFUSED_CURVE(MINVAR_COINCIDENT_JOINTS, 1, "joints 1 and 2");
    joints[3] = joints[0];
    data.closed = 1;
    REFUSED_CURVE(MINVAR_COINCIDENT_JOINTS, 3, "joints 3 and 0");

    joints[2] = minvar_joint_with_tangent(joints[2], MINVAR_FIXED, 0, 0, 0);
    REFUSED_CURVE(MINVAR_ZERO_TANGENT, 2, "joint 2");
    joints[2] = minvar_joint_with_tangent(joints[2], MINVAR_INITIAL, 0, -0.0, 0);
    REFUSED_CURVE(MINVAR_ZERO_TANGENT, 2, "joint 2");

    joints[0] = minvar_joint_with_curvature(joints[0], MINVAR_FIXED, 1e-5, 1, 0);
    REFUSED_CURVE(MINVAR_CURVATURE_NOT_PERPENDICULAR, 0, "joint 0");

    joints[1].tangent[0].given = MINVAR_FIXED;
    REFUSED_CURVE(MINVAR_SIDES_DIFFER, 1, "tangent");
    joints[1].continuity = MINVAR_G1;
    joints[1].tangent[1].value[0] = 2;
    joints[1].curvature[1] = joints[3].curvature[1];
    REFUSED_CURVE(MINVAR_SIDES_DIFFER, 1, "tangent");
    joints[1].curvature[1].value[0] = 0.2;
    joints[1].curvature[1].value[1] = -0.2;
    REFUSED_CURVE(MINVAR_SIDES_DIFFER, 1, "curvature");

    for (int i = 0; i < 3; i++) {
        joints[i].position.given = MINVAR_FREE;
    }
    REFUSED_CURVE(MINVAR_NO_POSITION, 0, "position");

    static const double scale[2] = {1e-100, 1e100};
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 4; k++) {
            joints[k].position.value[0] *= scale[i];
            joints[k].position.value[1] *= scale[i];
        }
        REFUSED_CURVE(MINVAR_SIZE_OUT_OF_RANGE, 0, "1e-90 to 1e90");
    }

    joints[3].position.value[2] = 0.1;
    options_data.dimension = 2;
    REFUSED_CURVE(MINVAR_NOT_PLANAR, 0, "plane");

    options_data.functional = 99;
    REFUSED_CURVE(MINVAR_BAD_OPTION, 0, "functional");
    options_data.elements_per_span = 0;
    REFUSED_CURVE(MINVAR_BAD_OPTION, 1, "elements_per_span");
    options_data.elements_per_span = 1025;
    REFUSED_CURVE(MINVAR_BAD_OPTION, 1, "elements_per_span");
    options_data.quadrature_points = 11;
    REFUSED_CURVE(MINVAR_BAD_OPTION, 2, "quadrature_points");
    options_data.quadrature_points = 33;
    REFUSED_CURVE(MINVAR_BAD_OPTION, 2, "quadrature_points");
    options_data.dimension = 1;
    REFUSED_CURVE(MINVAR_BAD_OPTION, 4, "dimension");
    static const double decrease[4] = {-1e-300, 1.0, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        options_data.relative_decrease = decrease[i];
        REFUSED_CURVE(MINVAR_BAD_OPTION, 6, "relative_decrease");
    }

    static minvar_obstacle obstacles_room[2];
    const minvar_obstacle good = {{1, 2, 0}, {2, 2, 0}, 0.25, MINVAR_LEFT};
    obstacles_room[0] = obstacles_room[1] = good;
    data.obstacles = obstacles_room;
    data.obstacle_count = 2;
    ARRAY(const minvar_obstacle, data.obstacles, data.obstacle_count, WORKSPACE_LEN, "curve->obstacles");
    reset();
#define REFUSED_OBSTACLE(change, wanted, at, word) \
    do { \
        data.obstacles = obstacles_room; \
        data.obstacle_count = 2; \
        change; \
        REFUSED_CURVE(wanted, at, word); \
        obstacles_room[1] = good; \
    } while (0)
    REFUSED_OBSTACLE(obstacles_room[1].clearance = -1, MINVAR_BAD_OBSTACLE, 1, "obstacle 1");
    REFUSED_OBSTACLE(obstacles_room[1].side = 2, MINVAR_BAD_OBSTACLE, 1, "obstacle 1");
    for (int bad = 0; bad < 3; bad++) {
        REFUSED_OBSTACLE(obstacles_room[1].clearance = BAD[bad], MINVAR_BAD_OBSTACLE, 1, "obstacle 1");
        for (int d = 0; d < 3; d++) {
            REFUSED_OBSTACLE(obstacles_room[1].from[d] = BAD[bad], MINVAR_BAD_OBSTACLE, 1, "obstacle 1");
            REFUSED_OBSTACLE(obstacles_room[1].to[d] = BAD[bad], MINVAR_BAD_OBSTACLE, 1, "obstacle 1");
        }
    }
    REFUSED_OBSTACLE(obstacles_room[1].to[2] = 1, MINVAR_OBSTACLES_NOT_POSSIBLE, 0, "planar");
    REFUSED_OBSTACLE(options_data.tolerance = 1e-3, MINVAR_OBSTACLES_NOT_POSSIBLE, 0, "tolerance");
    REFUSED_OBSTACLE(options_data.length = 9, MINVAR_OBSTACLES_NOT_POSSIBLE, 0, "length");

    /* Buffers one too short, and just long enough. */
    size_t needed = 0;
    WORKS(minvar_curve_workspace_len(curve, options, &needed, e));
    CHECK(needed > 0 && needed < 20000);
    workspace_len = needed - 1;
    REFUSED(SOLVE, MINVAR_WORKSPACE_TOO_SMALL, "workspace");
    CHECK(last.needed == needed && last.given == needed - 1);
    workspace_len = 0;
    workspace = NULL;
    REFUSED(SOLVE, MINVAR_WORKSPACE_TOO_SMALL, "workspace");
    CHECK(last.needed == needed && last.given == 0);
    workspace = workspace_room;
    workspace_len = needed;
    elements_len = 2;
    REFUSED(SOLVE, MINVAR_RESULT_TOO_SHORT, "elements");
    CHECK(last.needed == 3 && last.given == 2);
    elements_len = 0;
    elements = NULL;
    REFUSED(SOLVE, MINVAR_RESULT_TOO_SHORT, "elements");
    elements = elements_room;
    elements_len = 3;
    fill();
    workspace_room[needed] = 12.5;
    WORKS(SOLVE);
    CHECK(workspace_room[needed] == 12.5);
    CHECK(report_room.status == MINVAR_CONVERGED);
    CHECK(((unsigned char *)&elements_room[3])[0] == PATTERN && ((unsigned char *)&elements_room[3])[143] == PATTERN);
    records = NULL;
    records_len = 0;
    WORKS(SOLVE);
    records = records_room;
    records_len = 8;
}

/* ---- the functions that read elements ---- */

static minvar_element chain_room[3];
static minvar_element *chain = chain_room;
static size_t count = 3;
static minvar_point point_room;
static minvar_point *point = &point_room;
static minvar_figures figures_room;
static minvar_figures *figures = &figures_room;
typedef double row[3];
typedef double six_rows[6][3];
static six_rows bezier_room;
static six_rows *bezier = &bezier_room;
static row controls_room[32];
static row *controls = controls_room;
static size_t controls_len = 32;
static double knots_room[32];
static double *knots = knots_room;
static size_t knots_len = 32;
static size_t control_count_room, knot_count_room;
static size_t *control_count = &control_count_room, *knot_count = &knot_count_room;
static size_t place;
static double parameter, arc_length, near[3];
static double tolerance;
static minvar_gcode_options gcode_room;
static const minvar_gcode_options *gcode = &gcode_room;
static minvar_gcode_summary summary_room;
static minvar_gcode_summary *summary = &summary_room;

static int calls;
static int32_t visit_none(void *context, const minvar_move *step) {
    (void)context, (void)step;
    calls++;
    return 0;
}
static int32_t write_none(void *context, const char *text, size_t length) {
    (void)context, (void)text, (void)length;
    calls++;
    return 0;
}
static minvar_visitor visit = visit_none;
static minvar_writer writer = write_none;

#define BEZIER minvar_element_bezier(chain, bezier, e)
#define BSPLINE_LEN minvar_bspline_len(chain, count, control_count, knot_count, e)
#define BSPLINE minvar_bspline(chain, count, controls, controls_len, knots, knots_len, e)
#define MEASURE minvar_measure(chain, count, figures, e)
#define AT minvar_point_at(chain, count, place, parameter, point, e)
#define AT_LENGTH minvar_point_at_length(chain, count, arc_length, point, e)
#define CLOSEST minvar_closest_point(chain, count, near[0], near[1], near[2], point, e)
#define CHORDS minvar_chords(chain, count, tolerance, visit, NULL, e)
#define ARCS minvar_arcs(chain, count, tolerance, visit, NULL, e)
#define GCODE minvar_write_gcode(chain, count, gcode, writer, NULL, summary, e)

/* A straight element from a to b along x at height y, with curvature nowhere. */
static minvar_element line(double a, double b) {
    const double v = b - a;
    return (minvar_element){{{a, 0, 0}, {v, 0, 0}, {0, 0, 0}, {0, 0, 0}, {v, 0, 0}, {b, 0, 0}}};
}

static void chain_reset(void) {
    for (int i = 0; i < 3; i++) {
        chain_room[i] = line(i, i + 1.0);
        chain_room[i].rows[2][1] = chain_room[i].rows[3][1] = 0.5;
    }
    count = 3;
    controls_len = knots_len = 32;
    place = 1;
    parameter = 0.5;
    arc_length = 1.25;
    near[0] = near[1] = near[2] = 1;
    tolerance = 1e-3;
    gcode_room = minvar_gcode_defaults(1e-3, 100, 5);
}

/* What every function that reads a whole chain refuses. */
#define EVERY(call) \
    do { \
        chain_reset(); \
        ARRAY(minvar_element, chain, count, call, "elements"); \
        count = 0; \
        REFUSED(call, MINVAR_NO_ELEMENTS, "no elements"); \
        chain = NULL; \
        REFUSED(call, MINVAR_NO_ELEMENTS, "no elements"); \
        chain = chain_room; \
        count = 3; \
        for (int bad_ = 0; bad_ < 3; bad_++) { \
            for (int row_ = 0; row_ < 6; row_++) { \
                for (int d_ = 0; d_ < 3; d_++) { \
                    chain_room[2].rows[row_][d_] = BAD[bad_]; \
                    REFUSED(call, MINVAR_ELEMENT_NOT_FINITE, "element 2"); \
                    CHECK(last.index == 2); \
                    chain_reset(); \
                } \
            } \
        } \
    } while (0)

static void measure_functions(void) {
    watched_count = 0;
    watch(&point_room, sizeof point_room);
    watch(&figures_room, sizeof figures_room);
    watch(&bezier_room, sizeof bezier_room);
    watch(controls_room, sizeof controls_room);
    watch(knots_room, sizeof knots_room);
    watch(&control_count_room, sizeof control_count_room);
    watch(&knot_count_room, sizeof knot_count_room);

    chain_reset();
    POINTER(minvar_element, chain, BEZIER, "element");
    POINTER(six_rows, bezier, BEZIER, "points");
    ARRAY(minvar_element, chain, count, BSPLINE_LEN, "elements");
    POINTER(size_t, control_count, BSPLINE_LEN, "control_count");
    POINTER(size_t, knot_count, BSPLINE_LEN, "knot_count");
    EVERY(BSPLINE);
    ARRAY(row, controls, controls_len, BSPLINE, "controls");
    ARRAY(double, knots, knots_len, BSPLINE, "knots");
    EVERY(MEASURE);
    POINTER(minvar_figures, figures, MEASURE, "figures");
    EVERY(AT);
    POINTER(minvar_point, point, AT, "point");
    EVERY(AT_LENGTH);
    POINTER(minvar_point, point, AT_LENGTH, "point");
    EVERY(CLOSEST);
    POINTER(minvar_point, point, CLOSEST, "point");

    /* Buffers one too short. */
    WORKS(BSPLINE_LEN);
    const size_t needed_controls = control_count_room, needed_knots = knot_count_room;
    CHECK(needed_controls == 14 && needed_knots == 20);
    controls_len = needed_controls - 1;
    REFUSED(BSPLINE, MINVAR_RESULT_TOO_SHORT, "controls");
    CHECK(last.needed == needed_controls && last.given == needed_controls - 1);
    controls_len = needed_controls;
    knots_len = needed_knots - 1;
    REFUSED(BSPLINE, MINVAR_RESULT_TOO_SHORT, "knots");
    CHECK(last.needed == needed_knots && last.given == needed_knots - 1);
    knots_len = needed_knots;
    fill();
    WORKS(BSPLINE);
    CHECK(knots_room[0] == 0 && knots_room[needed_knots - 1] == 1 && controls_room[needed_controls - 1][0] == 3);
    CHECK(((unsigned char *)&knots_room[needed_knots])[0] == PATTERN);
    CHECK(((unsigned char *)&controls_room[needed_controls])[0] == PATTERN);
    count = 0;
    WORKS(BSPLINE_LEN);
    CHECK(control_count_room == 0 && knot_count_room == 0);
    chain_reset();

    /* An element that stands still where it should join on. */
    memset(chain_room[1].rows[4], 0, sizeof chain_room[1].rows[4]);
    REFUSED(BSPLINE, MINVAR_IRREGULAR, "element 1");
    CHECK(last.index == 1);
    parameter = 1;
    REFUSED(AT, MINVAR_IRREGULAR, "element 1");
    CHECK(last.index == 1);
    REFUSED(MEASURE, MINVAR_IRREGULAR, "element 1");
    chain_reset();
    memset(chain_room[0].rows[1], 0, sizeof chain_room[0].rows[1]);
    arc_length = 0;
    REFUSED(AT_LENGTH, MINVAR_IRREGULAR, "element 0");
    near[0] = -1;
    near[1] = near[2] = 0;
    REFUSED(CLOSEST, MINVAR_IRREGULAR, "element 0");
    chain_reset();

    place = 3;
    REFUSED(AT, MINVAR_OUT_OF_RANGE, "element");
    place = SIZE_MAX;
    REFUSED(AT, MINVAR_OUT_OF_RANGE, "element");
    place = 0;
    static const double off[5] = {-1e-9, 1 + 1e-9, NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 5; i++) {
        parameter = off[i];
        REFUSED(AT, MINVAR_OUT_OF_RANGE, "t must");
    }
    static const double beyond[5] = {-1e-3, 4, NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 5; i++) {
        arc_length = beyond[i];
        REFUSED(AT_LENGTH, MINVAR_OUT_OF_RANGE, "s must");
    }
    for (int i = 0; i < 9; i++) {
        chain_reset();
        near[i / 3] = BAD[i % 3];
        REFUSED(CLOSEST, MINVAR_OUT_OF_RANGE, "x, y and z");
    }
}

static void path_functions(void) {
    watched_count = 0;
    watch(&summary_room, sizeof summary_room);
    calls = 0;

    EVERY(CHORDS);
    EVERY(ARCS);
    EVERY(GCODE);
    POINTER(const minvar_gcode_options, gcode, GCODE, "options");
    summary = MISALIGNED(minvar_gcode_summary);
    REFUSED(GCODE, MINVAR_MISALIGNED, "summary");
    summary = &summary_room;
    visit = NULL;
    REFUSED(CHORDS, MINVAR_NULL_POINTER, "visit");
    REFUSED(ARCS, MINVAR_NULL_POINTER, "visit");
    visit = visit_none;
    writer = NULL;
    REFUSED(GCODE, MINVAR_NULL_POINTER, "write");
    writer = write_none;

    static const double no_tolerance[6] = {0, -0.0, -1, NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 6; i++) {
        tolerance = gcode_room.tolerance = no_tolerance[i];
        REFUSED(CHORDS, MINVAR_BAD_TOLERANCE, "tolerance");
        REFUSED(ARCS, MINVAR_BAD_TOLERANCE, "tolerance");
        REFUSED(GCODE, MINVAR_BAD_TOLERANCE, "tolerance");
    }
    tolerance = 1e-14;
    gcode_room.tolerance = 1e-6;
    REFUSED(CHORDS, MINVAR_TOLERANCE_TOO_FINE, "tolerance");
    REFUSED(ARCS, MINVAR_TOLERANCE_TOO_FINE, "tolerance");
    REFUSED(GCODE, MINVAR_TOLERANCE_TOO_FINE, "tolerance");
    chain_reset();

    chain_room[1].rows[0][0] += 1e-4;
    REFUSED(CHORDS, MINVAR_GAP, "element 1");
    CHECK(last.index == 1);
    REFUSED(ARCS, MINVAR_GAP, "element 1");
    REFUSED(GCODE, MINVAR_GAP, "element 1");
    chain_reset();
    chain_room[2].rows[2][2] = 1;
    REFUSED(ARCS, MINVAR_PATH_NOT_PLANAR, "element 2");
    CHECK(last.index == 2);
    REFUSED(GCODE, MINVAR_PATH_NOT_PLANAR, "element 2");
    CHECK(last.index == 2);
    chain_reset();
    memset(chain_room[1].rows[4], 0, sizeof chain_room[1].rows[4]);
    REFUSED(ARCS, MINVAR_IRREGULAR, "element 1");
    CHECK(last.index == 1);
    REFUSED(GCODE, MINVAR_IRREGULAR, "element 1");
    chain_reset();
    for (int i = 0; i < 3; i++) {
        chain_room[1].rows[i][0] = 1e101;
        REFUSED(CHORDS, MINVAR_ELEMENT_NOT_FINITE, "element 1");
        chain_reset();
    }

#define REFUSED_GCODE(wanted, at, word) \
    do { \
        REFUSED(GCODE, wanted, word); \
        CHECK(last.index == (at)); \
        chain_reset(); \
    } while (0)
    gcode_room.units = 2;
    REFUSED_GCODE(MINVAR_BAD_OPTION, 5, "units");
    gcode_room.plane = 3;
    REFUSED_GCODE(MINVAR_BAD_OPTION, 6, "plane");
    gcode_room.motion = UINT32_MAX;
    REFUSED_GCODE(MINVAR_BAD_OPTION, 7, "motion");
    static const uint32_t decimals[4] = {0, 5, 10, 262};
    for (int i = 0; i < 4; i++) {
        gcode_room.decimals = decimals[i];
        REFUSED_GCODE(MINVAR_BAD_DECIMALS, 0, "decimals");
    }
    static const double no_feed[6] = {0, -1, NAN, INFINITY, -INFINITY, 1e-9};
    for (int i = 0; i < 6; i++) {
        gcode_room.feed = no_feed[i];
        REFUSED_GCODE(MINVAR_BAD_FEED, 0, "the feed");
        if (no_feed[i] != 0) {
            gcode_room.plunge_feed = no_feed[i];
            REFUSED_GCODE(MINVAR_BAD_PLUNGE_FEED, 0, "the plunge feed");
        }
    }
    for (int i = 0; i < 3; i++) {
        gcode_room.depth = BAD[i];
        REFUSED_GCODE(MINVAR_BAD_DEPTH, 0, "depth");
        gcode_room.safe_height = BAD[i];
        REFUSED_GCODE(MINVAR_BAD_SAFE_HEIGHT, 0, "safe height");
    }
    gcode_room.depth = 1e30;
    REFUSED_GCODE(MINVAR_BAD_DEPTH, 0, "depth");
    gcode_room.safe_height = 0;
    REFUSED_GCODE(MINVAR_BAD_SAFE_HEIGHT, 0, "safe height");
    gcode_room.safe_height = 1e30;
    REFUSED_GCODE(MINVAR_BAD_SAFE_HEIGHT, 0, "safe height");
    chain_room[0] = line(0, 1e9);
    chain_room[1] = line(1e9, 2e9);
    chain_room[2] = line(2e9, 3e9);
    gcode_room.tolerance = 1;
    REFUSED_GCODE(MINVAR_COORDINATE_TOO_LARGE, 0, "element 0");

    if (calls != 0) {
        failures++;
        printf("a refused path called back %d times\n", calls);
    }
    WORKS(CHORDS);
    WORKS(ARCS);
    WORKS(GCODE);
    CHECK(calls > 0);
    summary = NULL;
    WORKS(GCODE);
}

/* ---- regions ---- */

static size_t region_first, region_count;
static minvar_joint held_room[3];
static minvar_joint *held = held_room;
static size_t held_count = 3;
static int32_t closed;

#define HOLD minvar_region_hold(chain, count, closed, region_first, region_count, held, held_count, e)

static void region_functions(void) {
    /* The joints are given and changed: what is refused leaves them alone. */
    watched_count = 0;
    watch(held_room, sizeof held_room);
    chain_reset();
    region_first = region_count = 1;
    ARRAY(minvar_element, chain, count, HOLD, "elements");
    ARRAY(minvar_joint, held, held_count, HOLD, "joints");
    for (held_count = 0; held_count < 2; held_count++) {
        REFUSED(HOLD, MINVAR_TOO_FEW_JOINTS, "two joints");
        CHECK(last.needed == 2 && last.given == held_count);
    }
    held_count = 3;
    static const size_t ranges[6][2] = {{1, 0}, {0, 4}, {3, 1}, {SIZE_MAX, 1}, {1, SIZE_MAX}, {SIZE_MAX, SIZE_MAX}};
    for (closed = 0; closed < 2; closed++) {
        for (int i = 0; i < 6; i++) {
            region_first = ranges[i][0];
            region_count = ranges[i][1];
            REFUSED(HOLD, MINVAR_BAD_REGION, region_count == 0 ? "no elements" : "a curve of 3");
            CHECK(last.index == region_first && last.needed == region_count && last.given == 3);
        }
    }
    region_first = region_count = 2;
    closed = 0;
    REFUSED(HOLD, MINVAR_BAD_REGION, "2 elements from element 2");
    closed = 1;
    WORKS(HOLD);
    closed = 0;
    region_first = region_count = 1;
    for (int bad = 0; bad < 3; bad++) {
        for (int i = 0; i < 3; i++) {
            chain_room[i].rows[1][0] = BAD[bad];
            if (i == 1) {
                WORKS(HOLD); /* the region's own elements are not read */
            } else {
                REFUSED(HOLD, MINVAR_BAD_REFERENCE, "beside the region");
                CHECK(last.index == (size_t)i);
            }
            chain_reset();
        }
    }
    memset(chain_room[0].rows[4], 0, sizeof chain_room[0].rows[4]);
    REFUSED(HOLD, MINVAR_BAD_REFERENCE, "element 0");
    chain_reset();

    /* What is held: the middle element's ends, the first as a corner. */
    held_room[0] = minvar_joint_with_continuity(minvar_joint_at(7, 7, 7), MINVAR_G0);
    held_room[1] = held_room[2] = minvar_joint_at(7, 7, 7);
    WORKS(HOLD);
    CHECK(held_room[0].position.value[0] == 1 && held_room[0].position.value[1] == 0);
    CHECK(held_room[0].tangent[1].given == MINVAR_FREE && held_room[0].curvature[1].given == MINVAR_FREE);
    CHECK(held_room[1].position.value[0] == 7 && held_room[1].tangent[0].given == MINVAR_FREE);
    CHECK(held_room[2].position.value[0] == 2 && held_room[2].tangent[0].value[0] == 1);
    CHECK(held_room[2].curvature[0].given == MINVAR_FIXED && held_room[2].curvature[0].value[1] == 0.5);
    point = &point_room;
    place = 2;
    parameter = 0;
    WORKS(AT);
    const minvar_joint there = minvar_joint_held_at(point_room);
    CHECK(there.continuity == MINVAR_G2 && there.position.given == MINVAR_FIXED);
    CHECK(memcmp(there.position.value, held_room[2].position.value, sizeof there.position.value) == 0);
    for (int side = 0; side < 2; side++) {
        const minvar_quantity *const q[2] = {&there.tangent[side], &there.curvature[side]};
        const minvar_quantity *const h[2] = {&held_room[2].tangent[side], &held_room[2].curvature[side]};
        for (int i = 0; i < 2; i++) {
            CHECK(q[i]->given == MINVAR_FIXED && h[i]->given == MINVAR_FIXED);
            CHECK(memcmp(q[i]->value, h[i]->value, sizeof q[i]->value) == 0);
        }
    }
}

/* Every code of the header but the one of callbacks, which another program provokes, and MINVAR_OK. */
static void completeness(void) {
    static const minvar_code all[] = {
        MINVAR_NULL_POINTER,       MINVAR_MISALIGNED,
        MINVAR_TOO_LONG,           MINVAR_TOO_FEW_JOINTS,
        MINVAR_CLOSED_TOO_FEW_JOINTS, MINVAR_JOINT_NOT_FINITE,
        MINVAR_UNKNOWN_CODE,       MINVAR_COINCIDENT_JOINTS,
        MINVAR_ZERO_TANGENT,       MINVAR_CURVATURE_NOT_PERPENDICULAR,
        MINVAR_SIDES_DIFFER,       MINVAR_NO_POSITION,
        MINVAR_SIZE_OUT_OF_RANGE,  MINVAR_NOT_PLANAR,
        MINVAR_BAD_OPTION,         MINVAR_WORKSPACE_TOO_SMALL,
        MINVAR_RESULT_TOO_SHORT,   MINVAR_NO_ELEMENTS,
        MINVAR_ELEMENT_NOT_FINITE, MINVAR_IRREGULAR,
        MINVAR_OUT_OF_RANGE,       MINVAR_BAD_TOLERANCE,
        MINVAR_TOLERANCE_TOO_FINE, MINVAR_GAP,
        MINVAR_PATH_NOT_PLANAR,    MINVAR_BAD_DECIMALS,
        MINVAR_BAD_FEED,           MINVAR_BAD_PLUNGE_FEED,
        MINVAR_BAD_DEPTH,          MINVAR_BAD_SAFE_HEIGHT,
        MINVAR_COORDINATE_TOO_LARGE, MINVAR_BAD_REGION,
        MINVAR_BAD_REFERENCE,        MINVAR_BAD_OBSTACLE,
        MINVAR_OBSTACLES_NOT_POSSIBLE,
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        if (!seen[all[i]]) {
            failures++;
            printf("code %d was never provoked\n", (int)all[i]);
        }
    }
}

int main(void) {
    curve_functions();
    measure_functions();
    region_functions();
    path_functions();
    completeness();
    CHECK(strcmp(minvar_status_sentence(MINVAR_CONVERGED), minvar_status_sentence(6)) != 0);
    CHECK(strcmp(minvar_status_sentence(UINT32_MAX), "unknown status") == 0);
    printf("%d refusals\n", refusals);
    return verdict();
}
