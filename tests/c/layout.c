/*
 * The layout of every struct on machines of 64 bits, as the C compiler sees it: the figures of ffi/src/layout.rs, to
 * which the Rust compiler holds the library. Printed as there, so that a test can compare the two.
 */
#include "minvar.h"

#include <assert.h>
#include <stdio.h>

#define FIELD(type, field, offset) static_assert(offsetof(type, field) == (offset), #type "." #field)
#define SIZE(type, size) static_assert(sizeof(type) == (size), #type)

FIELD(minvar_error, code, 0);
FIELD(minvar_error, index, 8);
FIELD(minvar_error, needed, 16);
FIELD(minvar_error, given, 24);
FIELD(minvar_error, message, 32);
SIZE(minvar_error, 224);

FIELD(minvar_quantity, given, 0);
FIELD(minvar_quantity, value, 8);
SIZE(minvar_quantity, 32);

FIELD(minvar_joint, continuity, 0);
FIELD(minvar_joint, position, 8);
FIELD(minvar_joint, tangent, 40);
FIELD(minvar_joint, curvature, 104);
FIELD(minvar_joint, guide, 168);
SIZE(minvar_joint, 192);

FIELD(minvar_obstacle, from, 0);
FIELD(minvar_obstacle, to, 24);
FIELD(minvar_obstacle, clearance, 48);
FIELD(minvar_obstacle, side, 56);
SIZE(minvar_obstacle, 64);

FIELD(minvar_curve, joints, 0);
FIELD(minvar_curve, joint_count, 8);
FIELD(minvar_curve, closed, 16);
FIELD(minvar_curve, reference, 24);
FIELD(minvar_curve, reference_count, 32);
FIELD(minvar_curve, reference_weight, 40);
FIELD(minvar_curve, obstacles, 48);
FIELD(minvar_curve, obstacle_count, 56);
SIZE(minvar_curve, 64);

FIELD(minvar_options, functional, 0);
FIELD(minvar_options, elements_per_span, 4);
FIELD(minvar_options, quadrature_points, 8);
FIELD(minvar_options, max_iterations, 12);
FIELD(minvar_options, dimension, 16);
FIELD(minvar_options, continuation, 20);
FIELD(minvar_options, relative_decrease, 24);
FIELD(minvar_options, tension, 32);
FIELD(minvar_options, bending, 40);
FIELD(minvar_options, length, 48);
FIELD(minvar_options, tolerance, 56);
SIZE(minvar_options, 64);

FIELD(minvar_element, rows, 0);
SIZE(minvar_element, 144);

FIELD(minvar_record, value, 0);
FIELD(minvar_record, predicted, 8);
FIELD(minvar_record, actual, 16);
FIELD(minvar_record, gradient, 24);
FIELD(minvar_record, step, 32);
FIELD(minvar_record, shift, 40);
SIZE(minvar_record, 48);

FIELD(minvar_report, status, 0);
FIELD(minvar_report, planar, 4);
FIELD(minvar_report, elements, 8);
FIELD(minvar_report, iterations, 16);
FIELD(minvar_report, linearisations, 24);
FIELD(minvar_report, unknowns, 32);
FIELD(minvar_report, value, 40);
FIELD(minvar_report, fine_value, 48);
FIELD(minvar_report, length, 56);
FIELD(minvar_report, variation, 64);
FIELD(minvar_report, bending, 72);
FIELD(minvar_report, error, 80);
FIELD(minvar_report, gradient, 88);
FIELD(minvar_report, decrement, 96);
SIZE(minvar_report, 104);

FIELD(minvar_point, element, 0);
FIELD(minvar_point, parameter, 8);
FIELD(minvar_point, arc_length, 16);
FIELD(minvar_point, point, 24);
FIELD(minvar_point, tangent, 48);
FIELD(minvar_point, curvature, 72);
FIELD(minvar_point, signed_curvature, 96);
FIELD(minvar_point, curvature_derivative, 104);
FIELD(minvar_point, torsion, 112);
SIZE(minvar_point, 120);

FIELD(minvar_figures, length, 0);
FIELD(minvar_figures, variation, 8);
FIELD(minvar_figures, bending, 16);
FIELD(minvar_figures, least_curvature, 24);
FIELD(minvar_figures, largest_curvature, 144);
FIELD(minvar_figures, box_low, 264);
FIELD(minvar_figures, box_high, 288);
SIZE(minvar_figures, 312);

FIELD(minvar_move, turn, 0);
FIELD(minvar_move, end, 8);
FIELD(minvar_move, centre, 32);
FIELD(minvar_move, deviation, 56);
SIZE(minvar_move, 64);

FIELD(minvar_gcode_options, tolerance, 0);
FIELD(minvar_gcode_options, feed, 8);
FIELD(minvar_gcode_options, plunge_feed, 16);
FIELD(minvar_gcode_options, safe_height, 24);
FIELD(minvar_gcode_options, depth, 32);
FIELD(minvar_gcode_options, units, 40);
FIELD(minvar_gcode_options, plane, 44);
FIELD(minvar_gcode_options, motion, 48);
FIELD(minvar_gcode_options, decimals, 52);
FIELD(minvar_gcode_options, comments, 56);
SIZE(minvar_gcode_options, 64);

FIELD(minvar_gcode_summary, lines, 0);
FIELD(minvar_gcode_summary, arcs, 8);
FIELD(minvar_gcode_summary, chords, 16);
FIELD(minvar_gcode_summary, length, 24);
FIELD(minvar_gcode_summary, minutes, 32);
FIELD(minvar_gcode_summary, deviation, 40);
SIZE(minvar_gcode_summary, 48);

static_assert(sizeof(minvar_code) == 4 && sizeof(minvar_status) == 4, "enums");

#define PRINT(field) printf("%s " #field ": %zu", separator, offsetof(TYPE, field)), separator = ","
#define BEGIN(name) printf(name " {"), separator = ""
#define END() printf(" } %zu\n", sizeof(TYPE))

int main(void) {
    const char *separator;
#define TYPE minvar_error
    BEGIN("minvar_error");
    PRINT(code);
    PRINT(index);
    PRINT(needed);
    PRINT(given);
    PRINT(message);
    END();
#undef TYPE
#define TYPE minvar_quantity
    BEGIN("minvar_quantity");
    PRINT(given);
    PRINT(value);
    END();
#undef TYPE
#define TYPE minvar_joint
    BEGIN("minvar_joint");
    PRINT(continuity);
    PRINT(position);
    PRINT(tangent);
    PRINT(curvature);
    PRINT(guide);
    END();
#undef TYPE
#define TYPE minvar_obstacle
    BEGIN("minvar_obstacle");
    PRINT(from);
    PRINT(to);
    PRINT(clearance);
    PRINT(side);
    END();
#undef TYPE
#define TYPE minvar_curve
    BEGIN("minvar_curve");
    PRINT(joints);
    PRINT(joint_count);
    PRINT(closed);
    PRINT(reference);
    PRINT(reference_count);
    PRINT(reference_weight);
    PRINT(obstacles);
    PRINT(obstacle_count);
    END();
#undef TYPE
#define TYPE minvar_options
    BEGIN("minvar_options");
    PRINT(functional);
    PRINT(elements_per_span);
    PRINT(quadrature_points);
    PRINT(max_iterations);
    PRINT(dimension);
    PRINT(continuation);
    PRINT(relative_decrease);
    PRINT(tension);
    PRINT(bending);
    PRINT(length);
    PRINT(tolerance);
    END();
#undef TYPE
#define TYPE minvar_element
    BEGIN("minvar_element");
    PRINT(rows);
    END();
#undef TYPE
#define TYPE minvar_record
    BEGIN("minvar_record");
    PRINT(value);
    PRINT(predicted);
    PRINT(actual);
    PRINT(gradient);
    PRINT(step);
    PRINT(shift);
    END();
#undef TYPE
#define TYPE minvar_report
    BEGIN("minvar_report");
    PRINT(status);
    PRINT(planar);
    PRINT(elements);
    PRINT(iterations);
    PRINT(linearisations);
    PRINT(unknowns);
    PRINT(value);
    PRINT(fine_value);
    PRINT(length);
    PRINT(variation);
    PRINT(bending);
    PRINT(error);
    PRINT(gradient);
    PRINT(decrement);
    END();
#undef TYPE
#define TYPE minvar_point
    BEGIN("minvar_point");
    PRINT(element);
    PRINT(parameter);
    PRINT(arc_length);
    PRINT(point);
    PRINT(tangent);
    PRINT(curvature);
    PRINT(signed_curvature);
    PRINT(curvature_derivative);
    PRINT(torsion);
    END();
#undef TYPE
#define TYPE minvar_figures
    BEGIN("minvar_figures");
    PRINT(length);
    PRINT(variation);
    PRINT(bending);
    PRINT(least_curvature);
    PRINT(largest_curvature);
    PRINT(box_low);
    PRINT(box_high);
    END();
#undef TYPE
#define TYPE minvar_move
    BEGIN("minvar_move");
    PRINT(turn);
    PRINT(end);
    PRINT(centre);
    PRINT(deviation);
    END();
#undef TYPE
#define TYPE minvar_gcode_options
    BEGIN("minvar_gcode_options");
    PRINT(tolerance);
    PRINT(feed);
    PRINT(plunge_feed);
    PRINT(safe_height);
    PRINT(depth);
    PRINT(units);
    PRINT(plane);
    PRINT(motion);
    PRINT(decimals);
    PRINT(comments);
    END();
#undef TYPE
#define TYPE minvar_gcode_summary
    BEGIN("minvar_gcode_summary");
    PRINT(lines);
    PRINT(arcs);
    PRINT(chords);
    PRINT(length);
    PRINT(minutes);
    PRINT(deviation);
    END();
#undef TYPE
    return 0;
}
