/* A program that calls only what CALLS says, or nothing: what it is longer than nothing is the library's code. */
#include "minvar.h"

int main(void) {
#if CALLS >= 1
    static double workspace[4096];
    static minvar_element elements[8];
    minvar_joint joints[2] = {minvar_joint_at(0, 0, 0), minvar_joint_at(1, 1, 0)};
    const minvar_curve curve = minvar_curve_through(joints, 2, 0);
    const minvar_options options = minvar_options_defaults();
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
