/* The curves of Appendix A and the project's own (tests/data/curves) with every functional, and every option with them. */
#include "corpus.h"

typedef struct {
    const char *name;
    const minvar_joint *joints;
    size_t joint_count;
    int32_t closed;
    const minvar_obstacle *obstacles;
    size_t obstacle_count;
} given_curve;

#include "curves.inc"

static problem problem_of(const given_curve *given) {
    problem data = blank();
    data.joint_count = given->joint_count;
    data.closed = given->closed;
    data.obstacle_count = given->obstacle_count;
    for (size_t i = 0; i < given->joint_count; i++) {
        data.joints[i] = given->joints[i];
    }
    for (size_t i = 0; i < given->obstacle_count; i++) {
        data.obstacles[i] = given->obstacles[i];
    }
    return data;
}

/* Of every quantity of a joint that is a place: the position, and the ends of obstacles. */
static void map(problem *data, double factor, double offset) {
    for (size_t i = 0; i < data->joint_count; i++) {
        minvar_joint *joint = &data->joints[i];
        for (int d = 0; d < 3; d++) {
            joint->position.value[d] = joint->position.value[d] * factor + offset;
            for (int side = 0; side < 2; side++) {
                joint->curvature[side].value[d] = joint->curvature[side].value[d] / factor;
            }
        }
    }
    for (size_t i = 0; i < data->obstacle_count; i++) {
        data->obstacles[i].clearance *= factor;
        for (int d = 0; d < 3; d++) {
            data->obstacles[i].from[d] = data->obstacles[i].from[d] * factor + offset;
            data->obstacles[i].to[d] = data->obstacles[i].to[d] * factor + offset;
        }
    }
}

static int is_flat(const given_curve *given) {
    for (size_t i = 0; i < given->joint_count; i++) {
        if (given->joints[i].position.value[2] != 0 || given->joints[i].tangent[0].value[2] != 0) {
            return 0;
        }
    }
    return 1;
}

static void functionals(const char *group, const given_curve *given, uint32_t from, uint32_t to) {
    static const char *const names[] = {"mvc", "mec", "si-mvc", "si-mec", "space-mvc", "space-mec"};
    problem data = problem_of(given);
    for (uint32_t functional = from; functional < to; functional++) {
        data.options.functional = functional;
        begin(group, given->name, names[functional]);
        course(&data, functional == MINVAR_MVC ? MAKE_PATHS : MEASURE);
    }
}

/* One option after the other, for the variation of curvature. */
static void options(const char *group, const given_curve *given) {
    const problem plain = problem_of(given);
    problem data = plain;
#define WITH(what, change) \
    do { \
        data = plain; \
        change; \
        begin(group, given->name, what); \
        course(&data, SOLVE); \
    } while (0)
    WITH("elements-2", data.options.elements_per_span = 2);
    WITH("elements-3", data.options.elements_per_span = 3);
    WITH("points-12", data.options.quadrature_points = 12);
    WITH("points-32", data.options.quadrature_points = 32);
    WITH("iterations-2", data.options.max_iterations = 2);
    WITH("dimension-3", data.options.dimension = 3);
    if (is_flat(given)) {
        WITH("torsion", (data.options.dimension = 3, data.options.functional = MINVAR_SPACE_MVC));
    }
    WITH("continuation", data.options.continuation = 2);
    WITH("decrease-1e-3", data.options.relative_decrease = 1e-3);
    WITH("decrease-1e-6", data.options.relative_decrease = 1e-6);
    WITH("tension", data.options.tension = 0.125);
    WITH("bending", data.options.bending = 0.125);
    WITH("mec-tension", (data.options.functional = MINVAR_MEC, data.options.tension = 0.125));
    WITH("small", map(&data, 1e-6, 0));
    WITH("large", map(&data, 1e6, 0));
    WITH("far", map(&data, 1, 1e6));
    WITH("cancelled", data.cancel_at = 2);
#undef WITH
}

/* What begins with the length or the shape of the curve. */
static void follow_ups(const char *group, const given_curve *given) {
    static minvar_element shape[MOST_ELEMENTS];
    const problem plain = problem_of(given);
    const size_t last = plain.joint_count - 1;
    begin(group, given->name, "again");
    if (!solve(&plain)) {
        return;
    }
    const size_t count = report.elements;
    const double length = report.length;
    for (size_t i = 0; i < count; i++) {
        shape[i] = elements[i];
    }

    problem data = plain;
    data.options.length = 1.125 * length;
    begin(group, given->name, "length");
    course(&data, SOLVE);

    data = plain;
    data.options.tolerance = length / 16384;
    data.options.elements_per_span = 8;
    begin(group, given->name, "tolerance");
    course(&data, SOLVE);

    problem moved = plain;
    moved.joints[last].position.value[0] += length / 64;
    moved.joints[last].position.value[1] -= length / 128;
    for (size_t i = 0; i < count; i++) {
        elements[i] = shape[i];
    }
    begin(group, given->name, "update");
    update(&moved);

    moved.reference = shape;
    moved.reference_weight = 0.75;
    begin(group, given->name, "reference");
    course(&moved, SOLVE);

    if (plain.joint_count < 3) {
        return;
    }
    /* The first two spans anew, the joint between them moved. */
    problem region = blank();
    region.joint_count = 3;
    for (size_t i = 0; i < 3; i++) {
        region.joints[i] = plain.joints[i];
    }
    minvar_error error;
    digest sum = empty_digest();
    const minvar_code code =
        minvar_region_hold(shape, count, plain.closed, 0, 2, region.joints, region.joint_count, &error);
    add_error(&sum, code, &error);
    for (size_t i = 0; i < 3; i++) {
        const minvar_joint *const joint = &region.joints[i];
        add_whole(&sum, joint->continuity);
        const minvar_quantity *const all[] = {&joint->position, &joint->tangent[0], &joint->tangent[1],
                                              &joint->curvature[0], &joint->curvature[1]};
        for (int k = 0; k < 5; k++) {
            add_whole(&sum, all[k]->given);
            add_doubles(&sum, all[k]->value, 3);
        }
    }
    begin(group, given->name, "region");
    end("held", &sum, code_word(code));
    region.joints[1].position.value[1] += length / 128;
    elements[0] = shape[0];
    elements[1] = shape[1];
    update(&region);
}

static void minima(const char *group, const given_curve *given) {
    enum { MOST = 3 };
    static minvar_report reports[MOST];
    problem data = problem_of(given);
    const minvar_curve curve = curve_of(&data);
    const size_t each = minvar_curve_elements_len(&curve, &data.options);
    minvar_error error;
    digest sum = empty_digest();
    size_t count = 0;
    const minvar_code code =
        minvar_curve_minima(&curve, &data.options, workspace, MOST_WORKSPACE, NULL, NULL, elements,
                            sizeof elements / sizeof *elements, reports, MOST, &count, &error);
    add_error(&sum, code, &error);
    add_whole(&sum, count);
    for (size_t i = 0; code == MINVAR_OK && i < count; i++) {
        add_report(&sum, &reports[i]);
        add_elements(&sum, elements + i * each, reports[i].elements);
    }
    begin(group, given->name, NULL);
    end("minima", &sum, code_word(code));
}

static int same(const char *one, const char *other) {
    while (*one != '\0' && *one == *other) {
        one++;
        other++;
    }
    return *one == *other;
}

static int among(const char *name, const char *const *names, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (same(name, names[i])) {
            return 1;
        }
    }
    return 0;
}

/* What takes long, for its joints or because nothing is fixed. */
static int is_heavy(const given_curve *given) {
    static const char *const names[] = {"figure_eight", "peters_helix", "rail_slide", "waves_slide"};
    return among(given->name, names, sizeof names / sizeof *names);
}

/* Two joints in a plane, three in space: every functional and every option. */
static int has_everything(const given_curve *given) {
    static const char *const names[] = {"coving", "space_curve"};
    return among(given->name, names, sizeof names / sizeof *names);
}

/* Seven joints, a joint that slides, a curvature's size; the rest is like one of those. */
static int has_options_in_long(const given_curve *given) {
    static const char *const names[] = {"woodford", "s_curve", "size_curvature", "coving_slide", "wicket"};
    return among(given->name, names, sizeof names / sizeof *names);
}

static int has_minima_in_long(const given_curve *given) {
    static const char *const names[] = {"loop", "wicket"};
    return among(given->name, names, sizeof names / sizeof *names);
}

static int has_follow_ups(const given_curve *given) {
    static const char *const names[] = {"coving", "space_curve", "g1_box", "s_curve"};
    return among(given->name, names, sizeof names / sizeof *names);
}

enum { CURVES = sizeof given_curves / sizeof *given_curves };

/* One more than the last functional that says something else of a curve: where data are planar, what knows torsion is MVC
 * and MEC. */
static uint32_t functionals_of(const given_curve *given) { return is_flat(given) ? MINVAR_SPACE_MVC : MINVAR_SPACE_MEC + 1; }

/* The functionals of every push. */
static uint32_t first_functionals(const given_curve *given) {
    return has_everything(given) ? functionals_of(given) : is_heavy(given) ? MINVAR_MEC : MINVAR_SI_MEC;
}

void appendix_a(void) {
    for (size_t i = 0; i < CURVES; i++) {
        const given_curve *const given = &given_curves[i];
        functionals("appendix", given, MINVAR_MVC, first_functionals(given));
        if (has_everything(given)) {
            options("appendix", given);
        }
        if (has_follow_ups(given)) {
            follow_ups("appendix", given);
        }
        if (is_flat(given) && has_everything(given)) {
            minima("appendix", given);
        }
    }
}

void more_of_appendix_a(void) {
    for (size_t i = 0; i < CURVES; i++) {
        const given_curve *const given = &given_curves[i];
        functionals("long", given, first_functionals(given), functionals_of(given));
        if (has_options_in_long(given)) {
            options("long", given);
        }
        if (has_minima_in_long(given)) {
            minima("long", given);
        }
        if (!has_follow_ups(given) && given->joint_count < 9) {
            follow_ups("long", given);
        }
    }
}
