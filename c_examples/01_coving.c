/*
 * 01_coving: the architect's job (thesis 4.11.5, Fig. 4.22).
 *
 * A room has a heating duct, 6 by 6 inches, in the corner of wall (x = 0) and ceiling (y = 0). Design a coving that
 * covers it, meets wall and ceiling smoothly, and is at most 12 inches high and 20 deep; then cut it from foam.
 *
 * The coving is the curve of least variation of curvature from the wall to the ceiling. The designer of 1992 raised the
 * curvature at the wall by hand until the curve looked clear of the duct. Here the duct's two faces are obstacles, to the
 * left of a curve that runs from the wall to the ceiling: it keeps its distance to them, the curvature at the wall is
 * what suits it best, and a file for the foam cutter comes out.
 *
 *     01_coving [OUTPUT.ngc [CLEARANCE]]       clearance in inches, 0.25 if not given
 *
 * No memory is allocated: the workspace is a static array, whose size the library checks.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "minvar.h"

#define ELEMENTS 8
#define FACES 2
/* What minvar_curve_elements_len() says: an obstacle counts as four spans. */
#define ROOM (ELEMENTS * (1 + 4 * FACES))
#define WORKSPACE 30000

static const double HEIGHT = 12.0, DEPTH = 20.0, THICKNESS = 0.5, DUCT = 6.0;

typedef struct {
    minvar_element elements[ROOM];
    minvar_report report;
    minvar_figures figures;
    double clearance; /* from the duct's free corner; negative if the curve cuts it off */
} coving;

static void check(minvar_code code, const minvar_error *error) {
    if (code != MINVAR_OK) {
        fprintf(stderr, "01_coving: %s\n", error->message);
        exit(2);
    }
}

static coving design(const minvar_curve *curve, unsigned elements_per_span) {
    static double workspace[WORKSPACE];
    coving result;
    minvar_error error;
    minvar_options options = minvar_options_defaults();
    options.elements_per_span = elements_per_span;

    check(minvar_curve_solve(curve, &options, workspace, WORKSPACE, NULL, NULL, result.elements, ROOM, NULL, 0,
                             &result.report, &error),
          &error);
    if (result.report.status != MINVAR_CONVERGED) {
        fprintf(stderr, "01_coving: %s\n", minvar_status_sentence(result.report.status));
        exit(1);
    }
    check(minvar_measure(result.elements, result.report.elements, &result.figures, &error), &error);

    /* How far to the left of the curve the corner lies: across the tangent at the nearest place. */
    minvar_point nearest;
    check(minvar_closest_point(result.elements, result.report.elements, DUCT, -DUCT, 0.0, &nearest, &error), &error);
    const double dx = DUCT - nearest.point[0], dy = -DUCT - nearest.point[1];
    result.clearance = nearest.tangent[0] * dy - nearest.tangent[1] * dx;
    return result;
}

static double curvature_at(const coving *c, size_t element, double t) {
    minvar_point point;
    minvar_error error;
    check(minvar_point_at(c->elements, c->report.elements, element, t, &point, &error), &error);
    return point.signed_curvature;
}

static void print_row(const char *name, const coving *c) {
    printf("%-24s %9.6f %10.6f %14.10f %10.6f %9.6f %9.4f %5lu\n", name, curvature_at(c, 0, 0.0), c->figures.length,
           c->figures.variation, c->figures.bending, curvature_at(c, c->report.elements - 1, 1.0), c->clearance,
           (unsigned long)c->report.iterations);
}

static int write_text(void *file, const char *text, size_t length) {
    return fwrite(text, 1, length, file) == length ? 0 : 1;
}

/* Writes beside the target first and renames, so that a failure leaves no half-written program. */
static void write_path(const char *name, const coving *c) {
    char draft[4096];
    minvar_error error;
    minvar_gcode_summary summary;
    /* Tolerance 0.001 inch, feed 40 inch/minute, wire parked at 2 inch. */
    minvar_gcode_options options = minvar_gcode_defaults(0.001, 40.0, 2.0);
    options.units = MINVAR_INCHES;

    if (snprintf(draft, sizeof draft, "%s.part", name) >= (int)sizeof draft) {
        fprintf(stderr, "01_coving: the name %s is too long\n", name);
        exit(3);
    }
    FILE *file = fopen(draft, "w");
    if (file == NULL) {
        perror(draft);
        exit(3);
    }
    const minvar_code code =
        minvar_write_gcode(c->elements, c->report.elements, &options, write_text, file, &summary, &error);
    const int closed = fclose(file);
    if (code != MINVAR_OK || closed != 0 || rename(draft, name) != 0) {
        fprintf(stderr, "01_coving: %s could not be written: %s\n", name,
                code != MINVAR_OK ? error.message : "the disk refused it");
        remove(draft);
        exit(3);
    }
    printf("\n%s: %lu arcs, %lu lines, %.4f in, %.2f min at 40 in/min, within %.6f in of the curve\n", name,
           (unsigned long)summary.arcs, (unsigned long)summary.chords, summary.length, summary.minutes,
           summary.deviation);
}

int main(int argc, char **argv) {
    const char *output = argc > 1 ? argv[1] : "coving.ngc";
    char *end = NULL;
    const double wanted = argc > 2 ? strtod(argv[2], &end) : 0.25;
    if ((argc > 2 && (end == argv[2] || *end != '\0')) || !(wanted >= 0.0 && wanted <= 3.0)) {
        fprintf(stderr, "01_coving: the clearance must be a number from 0 to 3 inches\n");
        return 2;
    }
    /* The file is put in place by renaming, which would replace a device: only names of NC programs are taken. */
    const char *ending = strrchr(output, '.');
    if (ending == NULL || strcmp(ending, ".ngc") != 0) {
        fprintf(stderr, "01_coving: the output %s must end in .ngc\n", output);
        return 2;
    }

    minvar_joint joints[2];
    joints[0] = minvar_joint_with_tangent(minvar_joint_at(THICKNESS, -HEIGHT, 0.0), MINVAR_FIXED, 0.0, 1.0, 0.0);
    joints[1] = minvar_joint_with_tangent(minvar_joint_at(DEPTH, -THICKNESS, 0.0), MINVAR_FIXED, 1.0, 0.0, 0.0);
    const minvar_obstacle duct[FACES] = {
        {{0.0, -DUCT, 0.0}, {DUCT, -DUCT, 0.0}, wanted, MINVAR_LEFT},
        {{DUCT, -DUCT, 0.0}, {DUCT, 0.0, 0.0}, wanted, MINVAR_LEFT},
    };
    minvar_curve curve = minvar_curve_through(joints, 2, 0);
    curve.obstacles = duct;
    curve.obstacle_count = FACES;

    /* As published: a curvature (1/inch, towards the room) found by hand, which cuts off the corner of a square duct. */
    minvar_joint by_hand[2] = {joints[0], joints[1]};
    by_hand[0] = minvar_joint_with_curvature(by_hand[0], MINVAR_FIXED, 0.27, 0.0, 0.0);
    const minvar_curve published = minvar_curve_through(by_hand, 2, 0);

    printf("%-24s %9s %10s %14s %10s %9s %9s %5s\n", "coving", "at wall", "length", "V", "E", "at end", "clearance",
           "iter");
    const coving one = design(&published, 1), fine = design(&published, ELEMENTS), chosen = design(&curve, ELEMENTS);
    print_row("Fig. 4.22, one element", &one);
    print_row("Fig. 4.22, 8 elements", &fine);
    print_row("clear of the duct", &chosen);
    printf("\ncurvature %.6f to %.6f, box %.4f to %.4f wide, %.4f to %.4f high\n",
           chosen.figures.least_curvature.signed_curvature, chosen.figures.largest_curvature.signed_curvature,
           chosen.figures.box_low[0], chosen.figures.box_high[0], chosen.figures.box_low[1],
           chosen.figures.box_high[1]);
    write_path(output, &chosen);
    return 0;
}
