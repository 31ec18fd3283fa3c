/*
 * minvar: fair curves for people who make things.
 *
 * CONVENTIONS
 *
 * Units      Lengths are in the caller's unit, curvatures 1/length, angles radians, feeds length/minute. A tolerance is
 *            a length. Planar signed curvature is positive to the left. Parameters run from 0 to 1 an element.
 * Results    Every function that can fail returns a minvar_code, MINVAR_OK (0) if it did what it says. On an error
 *            nothing was computed and no result was written; what a writer or visitor got before it stopped is the one
 *            exception. How a computation ended is not an error but a minvar_status in its report.
 * Arguments  const input first, then memory, then output, last the error, which may be NULL. Other pointers must not be
 *            NULL unless their function says so, but an array of no entries may be; a context is the caller's own and
 *            never looked at. Every function may return MINVAR_NULL_POINTER, MINVAR_MISALIGNED and MINVAR_TOO_LONG; its
 *            comment lists the other errors. A pointer that is neither NULL nor valid cannot be detected: behaviour is
 *            undefined then, as in all of C, and so it is where an output overlaps anything else.
 * Memory     The library never allocates, keeps no pointer after it returned, and has no global state. Workspaces come
 *            from the caller, who asks for the length first; one may be used again, dirty, for anything, after an error
 *            and after a callback stopped the work too. Nothing that it returns is to be freed.
 * Threads    Any number may call at once, each with its own memory; input may be shared. Callbacks come on the thread
 *            that called, before the call returns; one that asked to stop is not called again. The record or move that
 *            one is shown is a copy, which dies when it returns: writing into it changes nothing. It must leave alone
 *            the data, options and memory of the call that it belongs to.
 * Panics     None: in the library as it is released no path leads to one. A callback must return: it may neither throw
 *            through the library nor jump out of it.
 * Numbers    NaN, infinities and constants that are not defined come back as codes. The same input gives the same bits
 *            on every machine with IEEE 754 doubles in the default rounding mode.
 *
 * Licence: MIT or Apache-2.0. This file is written by cbindgen from ffi/: do not edit it.
 */


#ifndef MINVAR_H
#define MINVAR_H

#include <stddef.h>
#include <stdint.h>


// The number of this interface. It grows when something changes that compiled programs would notice.
#define MINVAR_ABI 2

// What was wrong with a call. Nothing was computed and no result was written, unless the code says otherwise. The
// numbers are fixed for good.
typedef enum minvar_code {
    // Nothing: the call did what it says.
    MINVAR_OK = 0,
    // A pointer is NULL that must not be; the message names the argument.
    MINVAR_NULL_POINTER = 1,
    // A pointer is not aligned for its type; the message names the argument. Where it is the error's own pointer, there
    // is no message.
    MINVAR_MISALIGNED = 2,
    // An array is longer than memory can be; the message names the argument.
    MINVAR_TOO_LONG = 3,
    // An open curve has fewer than two joints. `needed`, `given`.
    MINVAR_TOO_FEW_JOINTS = 10,
    // A closed curve has fewer than three joints. `needed`, `given`.
    MINVAR_CLOSED_TOO_FEW_JOINTS = 11,
    // A number of a joint is NaN or infinite. `index`: the joint.
    MINVAR_JOINT_NOT_FINITE = 12,
    // A `given` or the `continuity` of a joint is not one of the constants. `index`: the joint.
    MINVAR_UNKNOWN_CODE = 13,
    // Two neighbouring joints are at the same point, to 1e-12 of the data's extent. `index`: the first of them.
    MINVAR_COINCIDENT_JOINTS = 14,
    // A given tangent is the zero vector. `index`: the joint.
    MINVAR_ZERO_TANGENT = 15,
    // A given curvature is not perpendicular to the given tangent, to 1e-6 of its length. `index`: the joint.
    MINVAR_CURVATURE_NOT_PERPENDICULAR = 16,
    // A curvature is given where the direction of the curve is unknown. `index`: the joint.
    MINVAR_CURVATURE_NEEDS_TANGENT = 17,
    // The sides of a joint differ in what its continuity makes common. `index`: the joint.
    MINVAR_SIDES_DIFFER = 18,
    // Fewer than two joints have positions.
    MINVAR_NO_POSITION = 19,
    // The data are too large or too small for the arithmetic: lengths must be from 1e-90 to 1e90, and given radii of
    // curvature at least 1e-12 of the longest step between joints.
    MINVAR_SIZE_OUT_OF_RANGE = 20,
    // A planar curve was asked for but the data do not lie in a plane.
    MINVAR_NOT_PLANAR = 21,
    // An option has a value that it cannot have; the message names it. `index`: its place among the fields of the
    // options, from 0; one more than the last for the reference's weight.
    MINVAR_BAD_OPTION = 22,
    // The workspace is too short. `needed`, `given`, in doubles.
    MINVAR_WORKSPACE_TOO_SMALL = 23,
    // An array for results is too short; the message names it. `needed`, `given`, in its entries.
    MINVAR_RESULT_TOO_SHORT = 24,
    // The line or plane on which a joint slides has the zero vector as its direction. `index`: the joint.
    MINVAR_ZERO_GUIDE = 25,
    // The length that is asked for is no greater than that of the polygon through the fixed joints.
    MINVAR_LENGTH_TOO_SHORT = 26,
    // The reference shape has not as many elements as the curve. `needed`, `given`.
    MINVAR_WRONG_ELEMENT_COUNT = 27,
    // An element of the reference shape, of the start or beside a region is not finite or has no direction at an end.
    // `index`: the element.
    MINVAR_BAD_REFERENCE = 28,
    // An obstacle has a number that is not finite or beyond 1e100, a negative clearance or an unknown side. `index`: the
    // obstacle.
    MINVAR_BAD_OBSTACLE = 29,
    // Obstacles need a planar curve, without a tolerance, a reference shape, a given length or a warm start.
    MINVAR_OBSTACLES_NOT_POSSIBLE = 30,
    // A region has no elements, or some that the curve has not. `index`: its first element; `needed`: how many it has;
    // `given`: how many the curve has.
    MINVAR_BAD_REGION = 31,
    // There are no elements.
    MINVAR_NO_ELEMENTS = 40,
    // A number of an element is NaN, infinite or (in paths) beyond 1e100. `index`: the element.
    MINVAR_ELEMENT_NOT_FINITE = 41,
    // An element has no tangent somewhere: its derivative vanishes. `index`: the element.
    MINVAR_IRREGULAR = 42,
    // An element, parameter, arc length or point that a place is asked for by is NaN or beyond the curve; the message
    // says what it may be.
    MINVAR_OUT_OF_RANGE = 43,
    // The tolerance is zero, negative, NaN or infinite.
    MINVAR_BAD_TOLERANCE = 60,
    // The tolerance is finer than the numbers allow; the message says how fine it can be.
    MINVAR_TOLERANCE_TOO_FINE = 61,
    // An element does not begin where the one before ends, to a thousandth of the tolerance. `index`: the later element.
    MINVAR_GAP = 62,
    // An element leaves the plane z = constant, which arcs need. `index`: the element.
    MINVAR_PATH_NOT_PLANAR = 63,
    // The number of decimals is not 6 to 9.
    MINVAR_BAD_DECIMALS = 70,
    // The feed is not positive and finite, or rounds to zero.
    MINVAR_BAD_FEED = 71,
    // The plunge feed is not positive and finite, or rounds to zero.
    MINVAR_BAD_PLUNGE_FEED = 72,
    // The depth is not finite or too large for the decimals.
    MINVAR_BAD_DEPTH = 73,
    // The safe height is not above the cut, not finite or too large; the message says how high the cut reaches.
    MINVAR_BAD_SAFE_HEIGHT = 74,
    // A coordinate is too large for the decimals. `index`: the element.
    MINVAR_COORDINATE_TOO_LARGE = 75,
    // The caller's writer or visitor asked to stop: what it got is incomplete. Other results are untouched.
    MINVAR_STOPPED = 76,
    // No code: it keeps the enum at 32 bits where compilers would make it as short as its numbers (Arm's convention for
    // programs without an operating system, `-fshort-enums`).
    MINVAR_CODE_HAS_32_BITS = 2147483647,
} minvar_code;

// How a computation ended. A status is not an error: figures were computed, and the status says what they are worth.
// The numbers are fixed for good.
typedef enum minvar_status {
    // Nothing was computed yet.
    MINVAR_UNSOLVED = 0,
    // A minimum was reached: the functional cannot be lowered by what the tolerance asks for.
    MINVAR_CONVERGED = 1,
    // No further progress is possible though the tolerances are not met, or what was reached is no true minimum: a cusp, a
    // functional that a finer quadrature does not confirm, an element that would rather stop at its end. More elements may
    // help.
    MINVAR_STALLED = 2,
    // The allowed number of iterations was used up.
    MINVAR_ITERATION_LIMIT = 3,
    // The shape grows without limit while the functional sinks: these data have no minimum.
    MINVAR_UNBOUNDED = 4,
    // The observer asked to stop.
    MINVAR_CANCELLED = 5,
    // No status: it keeps the enum at 32 bits, as MINVAR_CODE_HAS_32_BITS does.
    MINVAR_STATUS_HAS_32_BITS = 2147483647,
} minvar_status;

// Whether a quantity is the solver's to choose.
typedef enum minvar_given {
    // Not given: the solver finds a start value and the best value.
    MINVAR_FREE = 0,
    // A start value: the solver goes on from it.
    MINVAR_INITIAL = 1,
    // Kept exactly.
    MINVAR_FIXED = 2,
    // Of a position: it slides on the line through the value along the joint's guide; the value is where it starts.
    MINVAR_ON_LINE = 3,
    // Of a position: it slides in the plane through the value across the joint's guide; the value is where it starts.
    MINVAR_ON_PLANE = 4,
    // Of a curvature: its size is kept, its direction is free. The value's direction is where it starts, if it does not
    // run along the tangent. A planar curve keeps the side to which it bends at the start.
    MINVAR_SIZE = 5,
} minvar_given;

// How the two elements at a joint meet.
typedef enum minvar_continuity {
    // A corner: tangent and curvature independent on either side.
    MINVAR_G0 = 0,
    // A common tangent, curvatures independent on either side.
    MINVAR_G1 = 1,
    // Common tangent and curvature.
    MINVAR_G2 = 2,
} minvar_continuity;

// What a curve is to minimise.
typedef enum minvar_functional {
    // The variation of curvature, integral of (d kappa/ds)^2 ds (thesis 4.2); 1/length^3.
    MINVAR_MVC = 0,
    // The bending energy, integral of kappa^2 ds (thesis 4.1); 1/length.
    MINVAR_MEC = 1,
    // The scale-invariant MVC, L^3 times the variation of curvature (thesis 4.5): it has a minimum where the MVC grows
    // without limit.
    MINVAR_SI_MVC = 2,
    // The scale-invariant MEC, L times the bending energy.
    MINVAR_SI_MEC = 3,
    // The variation of curvature and torsion, integral of (d kappa/ds)^2 + (d tau/ds)^2 ds (thesis 4.4); 1/length^3. It
    // vanishes on helices; torsion is continuous at G2 joints. Where a curve has an inflection, torsion counts less near
    // it. Planar data: MINVAR_MVC.
    MINVAR_SPACE_MVC = 4,
    // The energy of bending and twisting, integral of kappa^2 + tau^2 ds (thesis 4.3); 1/length. Planar data:
    // MINVAR_MEC.
    MINVAR_SPACE_MEC = 5,
} minvar_functional;

// A side of a curve, seen in the direction in which it runs.
typedef enum minvar_side {
    // The obstacle lies to the left of the curve: about the plane's normal, which is +z, +x or +y where the data lie in a
    // coordinate plane and else has its largest coordinate positive.
    MINVAR_LEFT = 0,
    // The obstacle lies to the right of the curve.
    MINVAR_RIGHT = 1,
} minvar_side;

// The unit of all lengths of a program: the curve's, the tolerance's and the feed's.
typedef enum minvar_units {
    // G21.
    MINVAR_MILLIMETRES = 0,
    // G20.
    MINVAR_INCHES = 1,
} minvar_units;

// The machine's plane in which the curve's x and y lie.
typedef enum minvar_plane {
    // G17: x, y, z are the machine's X, Y, Z.
    MINVAR_XY = 0,
    // G18: x, y, z are the machine's Z, X, Y.
    MINVAR_ZX = 1,
    // G19: x, y, z are the machine's Y, Z, X.
    MINVAR_YZ = 2,
} minvar_plane;

// How a path is cut.
typedef enum minvar_motion {
    // G2/G3 arcs and G1 lines of a curve in a plane z = constant.
    MINVAR_ARCS = 0,
    // G1 only, for any curve.
    MINVAR_CHORDS = 1,
} minvar_motion;

// A quintic element in Hermite form (thesis 4.5). Plain data: it may be copied, stored and sent.
typedef struct minvar_element {
    // The rows C(0), C'(0), C''(0), C''(1), C'(1), C(1), each x, y, z.
    double rows[6][3];
} minvar_element;

// An error with what it is about. The last argument of every function that can fail; it may be NULL if nobody wants to
// know. Every call fills it: after a success with MINVAR_OK and "no error".
typedef struct minvar_error {
    // The code, as returned.
    enum minvar_code code;
    // The joint, element, obstacle or option, from 0, that is to blame, where the code says so; else 0.
    size_t index;
    // How many entries are needed, where the code says so; else 0.
    size_t needed;
    // How many were given, where the code says so; else 0.
    size_t given;
    // One sentence in English, ASCII, NUL-terminated, that names the culprit. Its words may change; the codes do not.
    char message[192];
} minvar_error;

// The options of a curve: start from minvar_options_defaults().
typedef struct minvar_options {
    // One of enum minvar_functional. Default MINVAR_MVC.
    uint32_t functional;
    // Elements between two joints, 1 to 1024 (thesis 4.6). More approach the true curve. Default 1.
    uint32_t elements_per_span;
    // Gauss-Lobatto points an element, 12 to 32; 0 takes 16 as long as no more are needed and 32 where they tell a
    // difference. Default 0.
    uint32_t quadrature_points;
    // The largest number of iterations (trial steps). Default 500.
    uint32_t max_iterations;
    // 2 for a planar curve, 3 for a space curve, 0 to find out: planar where all data lie in a plane. Default 0.
    uint32_t dimension;
    // Stages of a continuation that starts under tension (thesis 4.10): each solves with a tenth of the tension of the one
    // before; the last solution is where the search without it starts. It leads to the minimum of shortest length where
    // start values alone lead elsewhere. At most 16. Default 0.
    uint32_t continuation;
    // Converged when another step promises to lower the functional by less than this fraction, or 20 iterations
    // together lowered it by less than a thousand times that; 0 to below 1. Of a functional that vanishes: this fraction
    // of a thousandth of what a bend by a radian on every chord costs. Above 1e-9 converged, too, when no step as long as
    // an element's speed promises more, and no other minima of single elements are looked for. Default 1e-12.
    double relative_decrease;
    // This weight times the length is added to the functional: a tension. In the functional's unit over a length, 0 or
    // more; 0 with a scale-invariant functional. Default 0.
    double tension;
    // This weight times the bending energy is added to the functional. In the functional's unit times a length, 0 or
    // more; 0 with a scale-invariant functional. Default 0.
    double bending;
    // The length of the curve, which a converged one has to a millionth of it; 0 leaves it free. Default 0.
    double length;
    // How far the curve may be from the true minimum, a length: spans are divided further until an estimate is below it,
    // into at most `elements_per_span` elements each. 0 takes just `elements_per_span`. Default 0.
    double tolerance;
} minvar_options;

// A vector and what it is. The value of a free quantity is not read.
typedef struct minvar_quantity {
    // One of enum minvar_given.
    uint32_t given;
    // The vector x, y, z: a position, a tangent of any length but zero, or a curvature vector in 1/length.
    double value[3];
} minvar_quantity;

// A joint: a point of the curve with what is known there (thesis 4.1, 4.5).
//
// Tangent and curvature are given for the arriving side (0) and the leaving side (1). Where the continuity makes a
// quantity common (the tangent at G1 and G2, the curvature at G2) both entries must be the same. The curvature vector
// points to the centre of curvature, has length 1/radius and is perpendicular to the tangent. A fixed curvature at a
// tangent that is not fixed means its size: the direction follows the tangent.
typedef struct minvar_joint {
    // One of enum minvar_continuity.
    uint32_t continuity;
    // The point.
    struct minvar_quantity position;
    // Arriving and leaving tangent.
    struct minvar_quantity tangent[2];
    // Arriving and leaving curvature vector.
    struct minvar_quantity curvature[2];
    // Where the position slides: the direction of its line, or the normal of its plane; of any length but zero. Not read
    // otherwise.
    double guide[3];
} minvar_joint;

// A point or a segment that a planar curve must leave on one side, at a distance.
//
// Where the curve would come too near it gets a contact: a place between two elements that rolls around the obstacle's
// end, or slides along the segment, at just that distance; position, tangent and curvature are continuous there. Contacts
// are taken up and given up one by one (an active set) until nothing is too near and every contact pushes. What an open
// curve does not pass, as it lies beyond the lines across its ends, is no obstacle to it.
typedef struct minvar_obstacle {
    // One end of the segment.
    double from[3];
    // The other; the same for a point.
    double to[3];
    // The distance that is kept, 0 or more.
    double clearance;
    // One of enum minvar_side: the side of the curve on which the obstacle stays.
    uint32_t side;
} minvar_obstacle;

// The designer's data: joints in order along the curve, owned by the caller, only read, and only while a call lasts.
typedef struct minvar_curve {
    // The joints; at least two, three of a closed curve.
    const struct minvar_joint *joints;
    // How many.
    size_t joint_count;
    // Not 0: the curve goes on from the last joint to the first, which is not repeated.
    int32_t closed;
    // A reference shape (thesis 4.6), or NULL: the curve minimises the integral of (d kappa/ds - w d kappa0/ds)^2 ds
    // with kappa0 the reference's curvature vector at the same element and parameter. As many elements as the curve has.
    // The search starts from it. With the weight 1 and its own joints the curve is the reference, and joints that move
    // deform it; with 0 it is the minimum variation curve. The speed's relative change along an element is held to the
    // reference's. For MINVAR_MVC, without a tolerance.
    const struct minvar_element *reference;
    // How many elements the reference has; 0 without one.
    size_t reference_count;
    // The weight w of the reference, 0 to 1.
    double reference_weight;
    // What a planar curve must keep clear of, or NULL; not with a reference, a tolerance, a given length or an update.
    const struct minvar_obstacle *obstacles;
    // How many; 0 without.
    size_t obstacle_count;
} minvar_curve;

// What one iteration did: one trial step, accepted or not; one on a curve's directions alone, which come first where a
// curve is planar, has only a value and a step. `value`, `predicted`, `actual` and `gradient` in the
// functional's unit (1/length^3 for MVC, 1/length for MEC), `step` and `shift` without one.
typedef struct minvar_record {
    // The functional after the iteration. In the first iterations it holds a term that keeps the parametrisation even.
    double value;
    // The decrease that the quadratic model promised for this step.
    double predicted;
    // The decrease that the step brought; negative where it was refused for raising the functional.
    double actual;
    // The largest gradient component before the step, each times its unknown's natural size.
    double gradient;
    // The length of the step in natural sizes.
    double step;
    // The shift that was added to the scaled Hessian; 0 is a pure Newton step.
    double shift;
} minvar_record;

// Watches a solve: called on the solving thread after every iteration with the caller's context, the iteration's
// number, from 1, and its record, which lives until the function returns. Return 0 to go on, anything else to stop with
// MINVAR_CANCELLED and the best curve so far: a whole one, with a report that belongs to it. Who asked to stop is not
// called again. It may call this library with other memory; it must return, not leave by longjmp() or an exception.
typedef int32_t (*minvar_observer)(void *context, size_t iteration, const struct minvar_record *record);

// How a curve came out. All figures in the caller's units; `value`, `fine_value` and `decrement` in the functional's.
// Of a shape that has grown beyond the arithmetic figures are infinite; none is NaN.
typedef struct minvar_report {
    // How the computation ended.
    enum minvar_status status;
    // 1 if the curve was computed in a plane, 0 in space.
    int32_t planar;
    // How many elements the curve has: as many as minvar_curve_elements_len() says, or fewer with a tolerance or
    // obstacles.
    size_t elements;
    // The number of iterations: trial steps, accepted or not.
    size_t iterations;
    // How often an element was linearised, over all elements: the work that was done.
    size_t linearisations;
    // The number of unknowns.
    size_t unknowns;
    // The functional's value by the rule that was minimised with.
    double value;
    // The functional's value by a finer rule: 32 points on each half, and on the halves of that wherever they do not
    // settle it; to 1e-6. A converged curve's differs from `value` by no more than 1e-4 of it; where by much more than
    // rounding, the curve is wild for its elements: take more of them.
    double fine_value;
    // The length L.
    double length;
    // The variation of curvature V, integral of (d kappa/ds)^2 ds; 1/length^3.
    double variation;
    // The bending energy E, integral of kappa^2 ds; 1/length.
    double bending;
    // The estimated distance from the true minimum, where a tolerance was asked for, else 0; infinite where there is no
    // estimate.
    double error;
    // The largest gradient component, each times its unknown's natural size, as a fraction of the functional; infinite
    // where little was asked for (a relative_decrease above 1e-9) and no step of the elements was needed for it.
    double gradient;
    // The decrease that another Newton step would promise; infinite where the Hessian is not positive definite. Where
    // no step was needed: an estimate of what the functional exceeds the true curve's by.
    double decrement;
} minvar_report;

// What holds at a place of a chain of elements, all in the caller's units.
typedef struct minvar_point {
    // The element, from 0.
    size_t element;
    // The parameter in it, 0 to 1.
    double parameter;
    // The arc length from the start of the chain.
    double arc_length;
    // The position.
    double point[3];
    // The unit tangent.
    double tangent[3];
    // The curvature vector, perpendicular to the tangent, towards the centre of curvature; 1/length.
    double curvature[3];
    // Planar chains: the curvature, positive to the left seen from the tip of the plane's normal (+z, +x or +y for
    // planes parallel to a coordinate plane). Space curves: the curvature's size. 1/length.
    double signed_curvature;
    // The derivative of signed_curvature by arc length; 1/length^2.
    double curvature_derivative;
    // The torsion, positive for a right-handed helix; 0 where the curvature vanishes; 1/length.
    double torsion;
} minvar_point;

// The figures of a whole chain.
typedef struct minvar_figures {
    // The length L.
    double length;
    // The variation of curvature V, integral of (d kappa/ds)^2 ds; 1/length^3.
    double variation;
    // The bending energy E, integral of kappa^2 ds; 1/length.
    double bending;
    // The place of the least signed curvature (space curves: size of curvature).
    struct minvar_point least_curvature;
    // The place of the largest.
    struct minvar_point largest_curvature;
    // The low corner x, y, z of the smallest box parallel to the axes that holds the chain.
    double box_low[3];
    // Its high corner.
    double box_high[3];
} minvar_figures;

// One move of a path, from where the last one ended.
typedef struct minvar_move {
    // 0: a line; 1: an arc to the left; -1: an arc to the right (clockwise).
    int32_t turn;
    // The end point x, y, z.
    double end[3];
    // The centre of an arc x, y, z; zeros of a line.
    double centre[3];
    // Proven: neither this move from its part of the curve nor that part from the move is farther than this length.
    double deviation;
} minvar_move;

// Receives the moves of a path in order, with the caller's context; `step` lives until the function returns. Return 0
// to go on, anything else to stop with MINVAR_STOPPED. It must return, not leave by longjmp() or an exception.
typedef int32_t (*minvar_visitor)(void *context, const struct minvar_move *step);

// What a program is to be: start from minvar_gcode_defaults(). Lengths are in the program's unit.
typedef struct minvar_gcode_options {
    // The greatest distance between the printed path and the curve, positive. No default.
    double tolerance;
    // The cutting feed, length/minute, positive. No default.
    double feed;
    // The feed while plunging, length/minute; 0 for the cutting feed. Default 0.
    double plunge_feed;
    // The third axis while moving to the start and after the end; above the cut. No default.
    double safe_height;
    // What is added to the curve's z while cutting: negative goes into the material. Default 0.
    double depth;
    // One of enum minvar_units. Default MINVAR_MILLIMETRES.
    uint32_t units;
    // One of enum minvar_plane. Default MINVAR_XY.
    uint32_t plane;
    // One of enum minvar_motion. Default MINVAR_ARCS.
    uint32_t motion;
    // Decimals printed, 6 to 9. Default 6.
    uint32_t decimals;
    // Not 0: explain the lines by comments in parentheses. Default 0.
    int32_t comments;
} minvar_gcode_options;

// Receives text, with the caller's context: `length` bytes of ASCII that are not NUL-terminated and live until the
// function returns. They come in pieces of any size, often of a few bytes: gather them in a buffer. Return 0 if all
// was taken, anything else to stop with MINVAR_STOPPED. It must return, not leave by longjmp() or an exception.
typedef int32_t (*minvar_writer)(void *context, const char *text, size_t length);

// What was written.
typedef struct minvar_gcode_summary {
    // The number of lines of text.
    size_t lines;
    // The number of G2 and G3 moves.
    size_t arcs;
    // The number of G1 moves that cut; the plunge is not counted.
    size_t chords;
    // The length of the cut, in the program's unit.
    double length;
    // The time of the cut at the programmed feed in minutes, without acceleration, plunge and rapids.
    double minutes;
    // Proven: no point of the printed cut is farther than this length from the curve (raised by `depth`), nor the
    // curve from the cut.
    double deviation;
} minvar_gcode_summary;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the library as `"MAJOR.MINOR.PATCH"`; static: not to be freed.
const char *minvar_version(void);

// 1 if the library has the interface that the caller was compiled with, else 0: call
// `minvar_abi_check(MINVAR_ABI)` once where the library is loaded dynamically.
int32_t minvar_abi_check(uint32_t abi);

// One English sentence on a status (of enum minvar_status) that a user can act on; static: not to be freed. A number
// that is no status gives "unknown status".
const char *minvar_status_sentence(uint32_t status);

// The six Bézier control points of one element, x, y, z each, in the caller's unit of length.
//
// Any element will do: numbers that are not finite give control points that are not.
enum minvar_code minvar_element_bezier(const struct minvar_element *element,
                                       double (*points)[6][3],
                                       struct minvar_error *error);

// The numbers of control points and of knots that minvar_bspline() writes for a chain of `count` elements; 0 and 0
// for none. The elements are read for corners, not checked.
enum minvar_code minvar_bspline_len(const struct minvar_element *elements,
                                    size_t count,
                                    size_t *control_count,
                                    size_t *knot_count,
                                    struct minvar_error *error);

// The whole chain as one non-rational B-spline of degree 5: the same curve point by point, C1 where the tangent is
// continuous. Knots from 0 to 1, six-fold at the ends, four-fold at smooth joints, five-fold at corners; a closed
// chain gives a spline whose ends meet.
//
// `controls` receives control points x, y, z in the caller's unit of length, `knots` six more knots than there are
// control points. `controls_len` and `knots_len` are the room in entries (points, knots), at least what
// minvar_bspline_len() says; entries beyond that are left alone. The arrays must not overlap.
//
// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_RESULT_TOO_SHORT, MINVAR_IRREGULAR where an element
// starts or ends without speed at another, or with so much less than it that two knots coincide.
enum minvar_code minvar_bspline(const struct minvar_element *elements,
                                size_t count,
                                double (*controls)[3],
                                size_t controls_len,
                                double *knots,
                                size_t knots_len,
                                struct minvar_error *error);

// The options' defaults, named at each field of minvar_options.
struct minvar_options minvar_options_defaults(void);

// A G2 joint at the fixed point x, y, z with free tangent and curvature. This and the three functions that follow only
// fill in a struct: their arguments are checked by the functions that take the joints.
struct minvar_joint minvar_joint_at(double x, double y, double z);

// The same joint sliding on the line through the point x, y, z, where it starts, along dx, dy, dz, of any length but
// zero.
struct minvar_joint minvar_joint_on_line(struct minvar_joint joint,
                                         double x,
                                         double y,
                                         double z,
                                         double dx,
                                         double dy,
                                         double dz);

// The same joint sliding in the plane through the point x, y, z, where it starts, across its normal nx, ny, nz, of any
// length but zero.
struct minvar_joint minvar_joint_on_plane(struct minvar_joint joint,
                                          double x,
                                          double y,
                                          double z,
                                          double nx,
                                          double ny,
                                          double nz);

// The same joint with the tangent x, y, z, of any length but zero, on both sides. `given`: one of enum minvar_given.
struct minvar_joint minvar_joint_with_tangent(struct minvar_joint joint, uint32_t given, double x, double y, double z);

// The same joint with the curvature vector x, y, z, in 1/length towards the centre of curvature, on both sides.
// `given`: one of enum minvar_given.
struct minvar_joint minvar_joint_with_curvature(struct minvar_joint joint,
                                                uint32_t given,
                                                double x,
                                                double y,
                                                double z);

// The same joint with another continuity: one of enum minvar_continuity.
struct minvar_joint minvar_joint_with_continuity(struct minvar_joint joint, uint32_t continuity);

// The curve through `joint_count` joints, without a reference shape or obstacles; `closed` as in minvar_curve. The joints
// stay the caller's.
struct minvar_curve minvar_curve_through(const struct minvar_joint *joints,
                                         size_t joint_count,
                                         int32_t closed);

// The number of elements that a curve will have, or with a tolerance or obstacles the most that it may have (an obstacle
// counts as four spans): spans times `elements_per_span`, with one span fewer than joints of an open curve and as many as
// joints of a closed one. Data and options are not checked otherwise; 0 if a pointer is NULL or misaligned.
size_t minvar_curve_elements_len(const struct minvar_curve *curve,
                                 const struct minvar_options *options);

// The workspace, in doubles, that minvar_curve_solve() needs for these data and options. It depends on the options, on
// the number of joints, on what is given there and on whether the data lie in a plane, not on the numbers otherwise.
//
// Errors: all that minvar_curve_solve() finds wrong with the data and options, but for MINVAR_CURVATURE_NEEDS_TANGENT,
// which shows with the start values.
enum minvar_code minvar_curve_workspace_len(const struct minvar_curve *curve,
                                            const struct minvar_options *options,
                                            size_t *len,
                                            struct minvar_error *error);

// Computes a curve (thesis chapter 4).
//
// `workspace`: `workspace_len` doubles, at least what minvar_curve_workspace_len() says, in any condition; what is left
// in it afterwards means nothing. `observer` may be NULL. `elements` receives minvar_curve_elements_len() elements in
// order along the curve, or with a tolerance or obstacles as many as `report->elements` says; `elements_len` is the room.
// `records` (may be NULL with `records_len` 0) receives a record an iteration as far as it reaches. What lies beyond in
// either array is left alone. The arrays must not overlap.
//
// Fixed positions and tangent directions are kept exactly; planar data give a curve in their plane.
//
// A curve that did not converge is no error: `report->status` says how the computation ended, and elements and report
// hold the best curve that was found.
//
// Errors: MINVAR_TOO_FEW_JOINTS to MINVAR_OBSTACLES_NOT_POSSIBLE, whatever is wrong with data, options or memory. All are
// found before any work: elements, records and report are untouched then.
enum minvar_code minvar_curve_solve(const struct minvar_curve *curve,
                                    const struct minvar_options *options,
                                    double *workspace,
                                    size_t workspace_len,
                                    minvar_observer observer,
                                    void *observer_context,
                                    struct minvar_element *elements,
                                    size_t elements_len,
                                    struct minvar_record *records,
                                    size_t records_len,
                                    struct minvar_report *report,
                                    struct minvar_error *error);

// Computes a curve anew from its last solution: a warm start for data that changed a little, as when a joint is dragged.
//
// As minvar_curve_solve(), but `elements` holds the last solution, minvar_curve_elements_len() elements, from which the
// search starts, and receives the new one; what the joints fix is taken from the joints. The search ends in the minimum
// that belongs to the last solution, so that a curve does not jump while it is dragged. A tolerance is not looked at: the
// number of elements stays.
//
// Errors: as minvar_curve_solve().
enum minvar_code minvar_curve_update(const struct minvar_curve *curve,
                                     const struct minvar_options *options,
                                     double *workspace,
                                     size_t workspace_len,
                                     minvar_observer observer,
                                     void *observer_context,
                                     struct minvar_element *elements,
                                     size_t elements_len,
                                     struct minvar_report *report,
                                     struct minvar_error *error);

// Looks for several minima of one curve: from the usual start values, from each start tangent turned round, and from each
// span bent the other way or further (thesis 4.10: curves with and without a loop). The list is what these starts lead
// to; it need not be complete.
//
// `reports` has room for `reports_len` reports and receives one a minimum, the lowest first. `elements` has room for
// `(reports_len + 1)` times minvar_curve_elements_len() elements: the first so many receive the first minimum's, and so on;
// the last are scratch. `count` receives the number of minima. `observer` sees every solve begin with iteration 1; if it
// asks to stop, the minima that were found before are the result, none if there were none, and the code is MINVAR_OK. The
// rest as in minvar_curve_solve().
//
// Errors: as minvar_curve_solve().
enum minvar_code minvar_curve_minima(const struct minvar_curve *curve,
                                     const struct minvar_options *options,
                                     double *workspace,
                                     size_t workspace_len,
                                     minvar_observer observer,
                                     void *observer_context,
                                     struct minvar_element *elements,
                                     size_t elements_len,
                                     struct minvar_report *reports,
                                     size_t reports_len,
                                     size_t *count,
                                     struct minvar_error *error);

// Measures a chain of `count` elements. Length, V and E are sums over the elements by 32-point rules, V and E by as
// many of them as it takes: what happens between two elements (a jump of curvature at a G1 joint) does not count.
//
// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_IRREGULAR.
enum minvar_code minvar_measure(const struct minvar_element *elements,
                                size_t count,
                                struct minvar_figures *figures,
                                struct minvar_error *error);

// What holds at parameter `t`, 0 to 1, of element `element`, from 0.
//
// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_OUT_OF_RANGE for `element` or `t` (NaN too),
// MINVAR_IRREGULAR where the curve has no tangent there.
enum minvar_code minvar_point_at(const struct minvar_element *elements,
                                 size_t count,
                                 size_t element,
                                 double t,
                                 struct minvar_point *point,
                                 struct minvar_error *error);

// What holds at arc length `s` from the start, 0 to the length of the chain; beyond either end by rounding (1e-9 of
// the length) is taken as that end. The start of an element rather than the end of the one before.
//
// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_OUT_OF_RANGE for `s` (NaN too), MINVAR_IRREGULAR where
// the curve has no tangent there.
enum minvar_code minvar_point_at_length(const struct minvar_element *elements,
                                        size_t count,
                                        double s,
                                        struct minvar_point *point,
                                        struct minvar_error *error);

// The place of a chain that is nearest to the point x, y, z; of several equally near ones the first. No place is
// missed: it is found from the roots of a polynomial.
//
// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_OUT_OF_RANGE if x, y or z is NaN or infinite,
// MINVAR_IRREGULAR where the curve has no tangent at the nearest place.
enum minvar_code minvar_closest_point(const struct minvar_element *elements,
                                      size_t count,
                                      double x,
                                      double y,
                                      double z,
                                      struct minvar_point *point,
                                      struct minvar_error *error);

// A G2 joint held at a place of a curve, as minvar_point_at() and its like find it: position, tangent and curvature fixed
// as they are there. A curve that starts or ends with it joins that curve with G2 continuity, to rounding. This only
// fills in a struct: its numbers are checked by the functions that take the joint.
struct minvar_joint minvar_joint_held_at(struct minvar_point place);

// Holds the ends of a region of a curve, which is to be computed anew while the rest stays as it is (thesis 4.4, local
// control).
//
// The curve is a chain of `count` elements, which returns to its start if `closed` is not 0. The region is
// `region_count` elements, 1 or more, from `first` on, from 0; of a closed curve they may run past the last element
// into the first ones. Its ends may be joints of the curve or any other ends of elements.
//
// `joints`: the region's joints in order, `joint_count`, two or more; inner ones may be moved, added and removed. The first
// and the last are changed: what a joint's continuity makes common is fixed as the rest has it there, the position to the
// last bit, of a G1 joint the tangent too, of a G2 joint the curvature vector as well. What the continuity leaves
// independent stays as given, and so does a joint where an open curve ends: its own conditions hold.
//
// Then the region is the open curve through these joints: minvar_curve_solve() computes it from its data,
// minvar_curve_update() from its old elements. If the number of elements stays, `elements + first` may receive the new
// ones, unless the region runs past the last. The functional is the region's own. For MINVAR_MVC and MINVAR_MEC, with a
// tension or a bending term or without, a region of a minimum whose joints did not move comes out as it was.
// Scale-invariant functionals and a given length look at the region's length alone, and the space functionals leave its
// torsion free at both ends: these move it.
//
//     minvar_region_hold(elements, 6, 0, 2, 2, joints, 3, &error);
//     const minvar_curve region = minvar_curve_through(joints, 3, 0);
//     minvar_curve_update(&region, &options, workspace, workspace_len, NULL, NULL, elements + 2, 2, &report, &error);
//
// Errors: MINVAR_BAD_REGION, MINVAR_TOO_FEW_JOINTS, MINVAR_BAD_REFERENCE for an element of the rest that has no direction
// where the region joins it. The joints are untouched then; all else about them is looked at when the curve is solved.
enum minvar_code minvar_region_hold(const struct minvar_element *elements,
                                    size_t count,
                                    int32_t closed,
                                    size_t first,
                                    size_t region_count,
                                    struct minvar_joint *joints,
                                    size_t joint_count,
                                    struct minvar_error *error);

// Calls `visit` with the chords of a chain, each within `tolerance` (a length) of its part: as few as a greedy choice
// makes. The first one begins where the chain does, at C(0) of element 0; every corner of the chain is the end of one.
//
// Errors: MINVAR_BAD_TOLERANCE, MINVAR_TOLERANCE_TOO_FINE, MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_GAP,
// all before the first move; MINVAR_STOPPED if the visitor stopped.
enum minvar_code minvar_chords(const struct minvar_element *elements,
                               size_t count,
                               double tolerance,
                               minvar_visitor visit,
                               void *context,
                               struct minvar_error *error);

// Calls `visit` with arcs and lines within `tolerance` (a length) of a chain in a plane z = constant: each biarc the
// longest that can be proven. They continue each other's tangent but for the corners of the chain. The first one begins
// where the chain does, at C(0) of element 0.
//
// Errors: as minvar_chords(), and MINVAR_PATH_NOT_PLANAR, MINVAR_IRREGULAR.
enum minvar_code minvar_arcs(const struct minvar_element *elements,
                             size_t count,
                             double tolerance,
                             minvar_visitor visit,
                             void *context,
                             struct minvar_error *error);

// The defaults named at each field, with the three that have none: tolerance and safe height are lengths, the feed is
// length/minute. Only fills in a struct: minvar_write_gcode() checks it.
struct minvar_gcode_options minvar_gcode_defaults(double tolerance, double feed, double safe_height);

// Writes a chain as one complete G-code program through `write`. The same input gives the same bytes on every machine.
//
// The lines: unit, plane, G90, G91.1, G94, G40, G80; rapid to the safe height and to the start; plunge; the cut at the
// feed; rapid to the safe height; M2. Each ends with `\n`. `summary` may be NULL.
//
// Errors: those of minvar_arcs() or, with MINVAR_CHORDS, of minvar_chords(); MINVAR_BAD_OPTION for an unknown unit,
// plane or motion; MINVAR_BAD_DECIMALS to MINVAR_COORDINATE_TOO_LARGE. All are found before the first character;
// only MINVAR_STOPPED, where `write` stopped, leaves part of a program behind.
enum minvar_code minvar_write_gcode(const struct minvar_element *elements,
                                    size_t count,
                                    const struct minvar_gcode_options *options,
                                    minvar_writer write,
                                    void *context,
                                    struct minvar_gcode_summary *summary,
                                    struct minvar_error *error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MINVAR_H */
