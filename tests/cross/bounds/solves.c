/*
 * What a whole solve takes, for curves of two and of seven joints and every functional: lines of fields between semicolons,
 * which scripts/cross/bounds.sh makes into a table.
 */
#include "minvar.h"
#include "platform/decimal.h"
#include "platform/meter.h"
#include "platform/platform.h"

enum { JOINTS = 7, MOST_ELEMENTS = 64, MOST_WORKSPACE = 16 * 1024 };

static double workspace[MOST_WORKSPACE];
static minvar_element elements[MOST_ELEMENTS];

static void number(uint64_t value) {
    char room[24];
    platform_print(";");
    platform_print(decimal(value, room));
}

/* 1 if the curve converged. */
static int row(const char *name, const minvar_joint *joints, size_t count, const char *words, minvar_options options) {
    const minvar_curve curve = minvar_curve_through(joints, count, 0);
    minvar_report report;
    size_t needed = 0;
    if (minvar_curve_workspace_len(&curve, &options, &needed, NULL) != MINVAR_OK || needed > MOST_WORKSPACE) {
        return 0;
    }
    meter_start();
    const minvar_code code = minvar_curve_solve(&curve, &options, workspace, needed, NULL, NULL, elements, MOST_ELEMENTS,
                                                NULL, 0, &report, NULL);
    const reading read = meter_stop();
    if (code != MINVAR_OK || report.status != MINVAR_CONVERGED) {
        return 0;
    }
    platform_print(name);
    platform_print(";");
    platform_print(words);
    number(report.elements);
    number(report.unknowns);
    number(needed * sizeof(double));
    number(read.stack);
    number(report.iterations);
    number(report.linearisations);
    number(read.instructions);
    platform_print("\n");
    return 1;
}

/* A million rounds of two instructions, or of as few as the compiler makes it: does the meter count instructions? */
static void calibrate(void) {
#ifdef __arm__
    meter_start();
    __asm__ volatile("movw r0, #0x4240\n movt r0, #0xf\n 1: subs r0, #1\n bne 1b" ::: "r0", "cc");
    const reading read = meter_stop();
    platform_print("calibration;2000002 instructions");
    for (int i = 0; i < 6; i++) {
        platform_print(";0");
    }
    number(read.instructions);
    platform_print("\n");
#endif
}

int main(void) {
    static const char *const words[] = {"MVC", "MEC", "SI-MVC", "SI-MEC", "space MVC", "space MEC"};
    static const double points[JOINTS][2] = {{0, 0}, {1, 1.9}, {2, 2.7}, {3, 2.6}, {4, 1.6}, {5, 0.89}, {6, 1.2}};
    /* Of the helix in figure 4.21 of the thesis. */
    static const double helix[JOINTS][2] = {{6.28319, 0}, {3.14159, 3.14159}, {0, 0}, {3.14159, -3.14159},
                                            {6.28319, 0}, {3.14159, 3.14159}, {0, 0}};
    minvar_joint two[2], two_lifted[2], seven[JOINTS], seven_lifted[JOINTS];
    two[0] = minvar_joint_with_tangent(minvar_joint_at(0.5, -12, 0), MINVAR_FIXED, 0, 1, 0);
    two[0] = minvar_joint_with_curvature(two[0], MINVAR_FIXED, 0.27, 0, 0);
    two[1] = minvar_joint_with_tangent(minvar_joint_at(20, -0.5, 0), MINVAR_FIXED, 1, 0, 0);
    two_lifted[0] = two[0];
    two_lifted[1] = minvar_joint_with_tangent(minvar_joint_at(20, -0.5, 6), MINVAR_FIXED, 1, 0, 0);
    for (int i = 0; i < JOINTS; i++) {
        seven[i] = minvar_joint_at(points[i][0], points[i][1], 0);
        seven_lifted[i] = minvar_joint_at(helix[i][0], helix[i][1], (6 - i) * 1.5708);
    }
    int good = 1;
    calibrate();
    for (uint32_t functional = MINVAR_MVC; functional <= MINVAR_SPACE_MEC; functional++) {
        minvar_options options = minvar_options_defaults();
        options.functional = functional;
        if (functional < MINVAR_SPACE_MVC) {
            good &= row("2 joints, planar", two, 2, words[functional], options);
            good &= row("7 joints, planar", seven, JOINTS, words[functional], options);
        }
        good &= row("2 joints, space", two_lifted, 2, words[functional], options);
        good &= row("7 joints, space", seven_lifted, JOINTS, words[functional], options);
    }
    minvar_options options = minvar_options_defaults();
    options.elements_per_span = 8;
    good &= row("2 joints, planar, 8 elements", two, 2, words[0], options);
    options = minvar_options_defaults();
    options.relative_decrease = 1e-6;
    good &= row("2 joints, planar, to 1e-6", two, 2, words[0], options);
    good &= row("7 joints, planar, to 1e-6", seven, JOINTS, words[0], options);
    return !good;
}
