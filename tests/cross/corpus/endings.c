/* Computations that end in other ways than by converging, and numbers at the edge of what is possible. */
#include "corpus.h"

#include <float.h>

static problem through(const double points[][2], size_t count, int32_t closed) {
    problem data = blank();
    data.joint_count = count;
    data.closed = closed;
    for (size_t i = 0; i < count; i++) {
        data.joints[i] = minvar_joint_at(points[i][0], points[i][1], 0);
    }
    return data;
}

/* Data that double back on a line, as a curve of one to three elements a span. */
static void folds(void) {
    static const double back[4][2] = {{0, 0}, {2, 0}, {1, 0}, {3, 0}};
    static const double triangle[3][2] = {{0, 0}, {3, 0}, {1, 0}};
    static const char *const names[] = {"open-1", "open-2", "open-3"};
    for (uint32_t parts = 1; parts <= 3; parts++) {
        problem data = through(back, 4, 0);
        data.options.elements_per_span = parts;
        begin("endings", "doubled-back", names[parts - 1]);
        course(&data, SOLVE);
    }
    problem data = through(triangle, 3, 1);
    begin("endings", "doubled-back", "closed");
    course(&data, SOLVE);
    data = through(back, 2, 0);
    for (size_t i = 0; i < 2; i++) {
        data.joints[i] = minvar_joint_with_tangent(data.joints[i], MINVAR_FIXED, -1, 0, 0);
    }
    begin("endings", "doubled-back", "tangents");
    course(&data, SOLVE);
}

/* The S that has a minimum up to a certain steepness of its ends, and none beyond. */
static void steep_curves(void) {
    for (unsigned k = 0; k < 9; k++) {
        problem data = blank();
        data.joint_count = 2;
        const double lean = 1 - 0.25 * k;
        for (size_t i = 0; i < 2; i++) {
            data.joints[i] =
                minvar_joint_with_tangent(minvar_joint_at(4.0 * (double)i, 0, 0), MINVAR_FIXED, lean, 1, 0);
        }
        data.options.elements_per_span = 1 + k % 3;
        begin_number("endings", "steep-s", k);
        course(&data, SOLVE);
    }
}

/* Nearly a whole turn on a circle: such data grow at first. */
static void turns(void) {
    static const double ends[3][2] = {{63, 16}, {255, 32}, {1023, 64}};
    for (unsigned k = 0; k < 3; k++) {
        problem data = blank();
        const double x = ends[k][0], y = ends[k][1];
        data.joint_count = 2;
        data.joints[0] = minvar_joint_with_tangent(minvar_joint_at(x, y, 0), MINVAR_FIXED, -y, x, 0);
        data.joints[1] = minvar_joint_with_tangent(minvar_joint_at(x, -y, 0), MINVAR_FIXED, y, x, 0);
        begin_number("endings", "turn", k);
        course(&data, SOLVE);
    }
}

/* Five gentle points. */
static const double points[5][2] = {{0, 0}, {1, 1}, {3, 1.5}, {4, 1}, {6, 1.25}};

/* A half circle by a rule of so few points that a finer one does not confirm it, and a tolerance out of reach. */
static void stalled(void) {
    problem data = blank();
    data.joint_count = 2;
    data.joints[0] = minvar_joint_with_tangent(minvar_joint_at(-1, 0, 0), MINVAR_FIXED, 0, 1, 0);
    data.joints[1] = minvar_joint_with_tangent(minvar_joint_at(1, 0, 0), MINVAR_FIXED, 0, -1, 0);
    data.options.quadrature_points = 12;
    begin("endings", "coarse-rule", NULL);
    course(&data, SOLVE);
    data.options = blank().options;
    data.options.functional = MINVAR_MEC;
    data.options.elements_per_span = 2;
    data.options.tolerance = 1e-9;
    data.options.max_iterations = 100;
    begin("endings", "out-of-reach", NULL);
    course(&data, SOLVE);
}

/* A given length is met, to a tolerance as well, or cannot be: 6.75 is hardly more than the straight ways. */
static void lengths(void) {
    static const double given[] = {6.75, 7, 8};
    for (unsigned k = 0; k < 3; k++) {
        problem data = through(points, 5, 0);
        data.options.length = given[k];
        data.options.max_iterations = 100;
        data.options.functional = k % 2 == 0 ? MINVAR_MVC : MINVAR_MEC;
        begin_number("endings", "length", k);
        course(&data, MEASURE);
        data.options.elements_per_span = 4;
        data.options.tolerance = 1e-4;
        begin_number("endings", "length-within-tolerance", k);
        course(&data, SOLVE);
    }
    problem data = through(points, 5, 0);
    data.options.length = 6;
    begin("endings", "length", "too-short");
    course(&data, SOLVE);
}

/* A curvature of which only the size is given, where the data without it run straight on: to which side it bends is
   a choice, and every machine's is the same. */
static void bent_from_straight(void) {
    for (unsigned k = 0; k < 6; k++) {
        static const double ways[3][3] = {{1, 0, 0}, {1, 2, 0}, {3, 2, -1}};
        problem data = blank();
        const double *const way = ways[k / 2];
        data.joint_count = 3;
        for (size_t i = 0; i < 3; i++) {
            const double at = (double)i;
            data.joints[i] = minvar_joint_at(at * way[0], at * way[1], at * way[2]);
        }
        minvar_joint *const bent = &data.joints[k % 2];
        *bent = minvar_joint_with_tangent(*bent, MINVAR_FIXED, way[0], way[1], way[2]);
        *bent = minvar_joint_with_curvature(*bent, MINVAR_SIZE, 0.25, 0, 0);
        begin_number("endings", "bent-from-straight", k);
        course(&data, SOLVE);
    }
}

static void cancelled(void) {
    for (size_t at = 1; at <= 6; at++) {
        problem data = through(points, 5, 0);
        data.options.elements_per_span = 3;
        data.cancel_at = at;
        begin_number("endings", "cancelled", (unsigned)at);
        course(&data, SOLVE);
        data.options.elements_per_span = 8;
        data.options.tolerance = 1e-4;
        begin_number("endings", "cancelled-within-tolerance", (unsigned)at);
        course(&data, SOLVE);
    }
    for (uint32_t most = 0; most < 6; most++) {
        problem data = through(points, 5, 0);
        data.options.elements_per_span = 3;
        data.options.max_iterations = most;
        begin_number("endings", "limited", most);
        course(&data, SOLVE);
    }
}

/* Sizes from 1e-90 to 1e90: subnormal numbers and near-overflows on the way. */
static void sizes(void) {
    static const double scales[] = {1e-89, 1e-60, 1e-20, 1e20, 1e60, 1e89};
    for (unsigned k = 0; k < sizeof scales / sizeof *scales; k++) {
        problem data = through(points, 4, 0);
        for (size_t i = 0; i < 4; i++) {
            for (int d = 0; d < 2; d++) {
                data.joints[i].position.value[d] *= scales[k];
            }
        }
        begin_number("endings", "size", k);
        course(&data, SOLVE);
        data.options.functional = MINVAR_SI_MEC;
        begin_number("endings", "size-si-mec", k);
        course(&data, SOLVE);
    }
}

void endings(void) {
    folds();
    steep_curves();
    turns();
    stalled();
    lengths();
    bent_from_straight();
    cancelled();
    sizes();
}
