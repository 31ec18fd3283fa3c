/* Curves through random data. The numbers are small multiples of powers of two, from integers alone. */
#include "corpus.h"

/* SplitMix64. Every throw is in a statement of its own: in what order C evaluates arguments is the compiler's choice. */
static uint64_t dice;

static void throw_from(uint64_t seed) { dice = seed * UINT64_C(0x2545f4914f6cdd1d); }

static uint32_t below(uint32_t count) {
    dice += UINT64_C(0x9e3779b97f4a7c15);
    uint64_t x = dice;
    x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
    return (uint32_t)(((x ^ x >> 31) >> 32) * count >> 32);
}

static int one_in(uint32_t count) { return below(count) == 0; }

/* From -most to most in steps of 1/64. */
static double within(int32_t most) { return ((int32_t)below((uint32_t)(128 * most + 1)) - 64 * most) / 64.0; }

typedef struct {
    double x, y, z;
} vector;

static vector vector_within(int32_t xy, int32_t z) {
    vector v = {0, 0, 0};
    v.x = within(xy);
    v.y = within(xy);
    v.z = z > 0 ? within(z) : 0;
    return v;
}

/* Of few bits, so that it is exact and perpendicular to the last of them. */
static vector across(vector a, vector b, double size) {
    const vector v = {size * (a.y * b.z - a.z * b.y), size * (a.z * b.x - a.x * b.z), size * (a.x * b.y - a.y * b.x)};
    return v;
}

static minvar_joint with_tangent(minvar_joint joint, int planar) {
    vector tangent = {0, 0, 0};
    while (tangent.x == 0 && tangent.y == 0) {
        tangent = vector_within(2, planar ? 0 : 2);
    }
    const uint32_t given = one_in(3) ? MINVAR_INITIAL : MINVAR_FIXED;
    joint = minvar_joint_with_tangent(joint, given, tangent.x, tangent.y, tangent.z);
    if (one_in(2)) {
        return joint;
    }
    vector other = {0, 0, 1};
    if (!planar) {
        other = vector_within(1, 1);
    }
    const vector curvature = across(tangent, other, within(1) / 8);
    const uint32_t kind = one_in(3) ? MINVAR_INITIAL : one_in(3) ? MINVAR_SIZE : MINVAR_FIXED;
    return minvar_joint_with_curvature(joint, kind, curvature.x, curvature.y, curvature.z);
}

static minvar_options some_options(int planar) {
    static const double decreases[] = {1e-12, 1e-12, 1e-9, 1e-6, 1e-3};
    minvar_options options = minvar_options_defaults();
    options.functional = below(planar ? 4 : 6);
    options.elements_per_span = 1 + (one_in(3) ? below(4) : 0);
    options.quadrature_points = one_in(4) ? 12 + below(21) : 0;
    options.max_iterations = MOST_ITERATIONS;
    options.relative_decrease = decreases[below(5)];
    const int scale_invariant = options.functional == MINVAR_SI_MVC || options.functional == MINVAR_SI_MEC;
    if (one_in(6) && !scale_invariant) {
        options.tension = (1 + below(64)) / 64.0;
    }
    if (one_in(6) && !scale_invariant) {
        options.bending = (1 + below(64)) / 64.0;
    }
    if (one_in(8)) {
        options.continuation = 1 + below(2);
    }
    return options;
}

static void walk(problem *data, int planar) {
    data->joint_count = 2 + below(planar ? 6 : 3);
    double x = within(4);
    for (size_t i = 0; i < data->joint_count; i++) {
        x += (16 + below(96)) / 64.0;
        const vector aside = vector_within(2, planar ? 0 : 2);
        minvar_joint joint = minvar_joint_at(x, aside.y, aside.z);
        if (one_in(3)) {
            joint = with_tangent(joint, planar);
        }
        if (one_in(8)) {
            joint = minvar_joint_with_continuity(joint, below(2));
        }
        if (i > 0 && i + 1 < data->joint_count && one_in(6)) {
            const vector lean = vector_within(1, 0);
            joint = planar || one_in(2) ? minvar_joint_on_line(joint, x, aside.y, aside.z, lean.x, 1, 0)
                                        : minvar_joint_on_plane(joint, x, aside.y, aside.z, 1, lean.x, lean.y);
        }
        data->joints[i] = joint;
    }
    data->options = some_options(planar);
}

/* Every fourth curve is made into paths. */
static void run(const problem *data, const char *group, const char *name, unsigned k) {
    begin_number(group, name, k);
    course(data, k % 4 == 0 ? MAKE_PATHS : k % 2 == 0 ? MEASURE : SOLVE);
}

static void walks(const char *group, const char *name, unsigned from, unsigned to, int planar) {
    for (unsigned k = from; k < to; k++) {
        problem data = blank();
        throw_from((planar ? 1000u : 2000u) + k);
        walk(&data, planar);
        run(&data, group, name, k);
    }
}

static void rings(const char *group, unsigned from, unsigned to) {
    static const int corners[8][2] = {{4, 0}, {3, 3}, {0, 4}, {-3, 3}, {-4, 0}, {-3, -3}, {0, -4}, {3, -3}};
    for (unsigned k = from; k < to; k++) {
        problem data = blank();
        throw_from(3000 + k);
        const int planar = !one_in(3);
        data.closed = 1;
        for (size_t i = 0; i < 8; i++) {
            if (one_in(4) && data.joint_count + 8 - i > 3) {
                continue;
            }
            const double radius = (32 + below(64)) / 64.0;
            minvar_joint joint =
                minvar_joint_at(radius * corners[i][0], radius * corners[i][1], planar ? 0 : within(1));
            if (one_in(6)) {
                joint.position.given = MINVAR_INITIAL;
            }
            data.joints[data.joint_count++] = joint;
        }
        data.options = some_options(planar);
        run(&data, group, "closed", k);
    }
}

/* A gentle wave with points and segments near it. */
static void obstacles(const char *group, unsigned from, unsigned to) {
    for (unsigned k = from; k < to; k++) {
        problem data = blank();
        throw_from(4000 + k);
        data.joint_count = 2 + below(3);
        for (size_t i = 0; i < data.joint_count; i++) {
            data.joints[i] = minvar_joint_at(3.0 * (double)i, within(1), 0);
        }
        data.obstacle_count = 1 + below(3);
        for (size_t i = 0; i < data.obstacle_count; i++) {
            minvar_obstacle *const obstacle = &data.obstacles[i];
            obstacle->from[0] = 0.5 + (1 + below(127)) / 64.0 * (double)(data.joint_count - 1);
            obstacle->side = below(2);
            obstacle->from[1] = obstacle->side == MINVAR_LEFT ? within(1) + 0.5 : within(1) - 0.5;
            obstacle->clearance = below(33) / 64.0;
            for (int d = 0; d < 2; d++) {
                obstacle->to[d] = obstacle->from[d] + (one_in(2) ? 0 : within(1) / 2);
            }
        }
        data.options.functional = below(4);
        data.options.elements_per_span = 1 + below(2);
        run(&data, group, "obstacles", k);
    }
}

void random_curves(void) {
    walks("random", "planar", 0, 16, 1);
    walks("random", "space", 0, 4, 0);
    rings("random", 0, 2);
    obstacles("random", 0, 4);
}

void more_random_curves(void) {
    walks("long", "planar", 16, 64, 1);
    walks("long", "space", 4, 32, 0);
    rings("long", 2, 16);
    obstacles("long", 4, 20);
}
