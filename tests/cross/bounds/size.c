/*
 * A program that calls only what CALLS says, or nothing: what it is longer than nothing is the library's code, and what it
 * does more is one solve, of the coving of the thesis (two joints) or through seven points.
 */
#include "minvar.h"

#ifndef JOINTS
#define JOINTS 2
#endif
#ifndef DECREASE
#define DECREASE 1e-12
#endif

int main(void) {
#if CALLS >= 1
    static double workspace[4096];
    static minvar_element elements[8];
#if JOINTS == 7
    const minvar_joint joints[7] = {minvar_joint_at(0, 0, 0),   minvar_joint_at(1, 1.9, 0),  minvar_joint_at(2, 2.7, 0),
                                    minvar_joint_at(3, 2.6, 0), minvar_joint_at(4, 1.6, 0),  minvar_joint_at(5, 0.89, 0),
                                    minvar_joint_at(6, 1.2, 0)};
#else
    minvar_joint joints[2] = {minvar_joint_at(0.5, -12, 0), minvar_joint_at(20, -0.5, 0)};
    joints[0] = minvar_joint_with_tangent(joints[0], MINVAR_FIXED, 0, 1, 0);
    joints[0] = minvar_joint_with_curvature(joints[0], MINVAR_FIXED, 0.27, 0, 0);
    joints[1] = minvar_joint_with_tangent(joints[1], MINVAR_FIXED, 1, 0, 0);
#endif
    const minvar_curve curve = minvar_curve_through(joints, JOINTS, 0);
    minvar_options options = minvar_options_defaults();
    options.relative_decrease = DECREASE;
    minvar_report report;
    minvar_curve_solve(&curve, &options, workspace, 4096, NULL, NULL, elements, 8, NULL, 0, &report, NULL);
#endif
#if CALLS >= 2
    minvar_figures figures;
    minvar_measure(elements, report.elements, &figures, NULL);
#endif
#if CALLS >= 3
    const minvar_gcode_options gcode = minvar_gcode_defaults(1e-3, 100, 5);
    minvar_write_gcode(elements, report.elements, &gcode, 0, NULL, NULL, NULL);
#endif
    return 0;
}
