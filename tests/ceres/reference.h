/* The independent reference for fair curves: what Rust sees of the C++ beside it.
 *
 * Rows are the quintic Hermite rows of one element, 18 doubles in the thesis's order
 * C(0), C'(0), C''(0), C''(1), C'(1), C(1). Planar curves lie in xy with z = 0.
 * Every function returns 0, or 1 with one sentence in `message`; nothing is written then.
 * No state is shared: any number of threads may call at once.
 */
#ifndef MINVAR_REFERENCE_H
#define MINVAR_REFERENCE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { REFERENCE_FREE = 0, REFERENCE_INITIAL = 1, REFERENCE_FIXED = 2 };
enum { REFERENCE_MVC = 0, REFERENCE_MEC = 1, REFERENCE_SI_MVC = 2 };
enum { REFERENCE_MESSAGE = 160 };

/* One interpolated joint. A position is INITIAL (it may move) or FIXED. A FIXED curvature at a tangent that is not FIXED keeps
 * its size, and the rotation that takes the initial tangent to the present one carries it. */
typedef struct {
    double position[3], tangent[3], curvature[3];
    int32_t position_status, tangent_status, curvature_status;
    int32_t continuity; /* 0, 1, 2: G0 shares the point, G1 the tangent too, G2 the curvature too */
} reference_joint;

typedef struct {
    const reference_joint *joints;
    size_t joint_count;
    int32_t closed, planar, elements_per_span, functional;
    int32_t points; /* Gauss-Legendre points per element */
} reference_problem;

typedef struct {
    int32_t ceres_iterations;  /* Levenberg-Marquardt; 0 skips it */
    int32_t newton_iterations; /* exact Hessian; 0 skips it */
    double function_tolerance, gradient_tolerance, parameter_tolerance; /* Ceres's own */
} reference_options;

typedef struct {
    double V, E, L;              /* int (d kappa/ds)^2 ds, int kappa^2 ds, int ds */
    double kappa_min, kappa_max; /* signed (positive to the left) when planar, otherwise the size */
} reference_measure;

/* How near rows are to a stationary point of the functional over the thesis's free parameters. */
typedef struct {
    double value;
    double gradient;            /* largest |d value / d parameter| */
    double decrement;           /* what one more Newton step would still gain, all curvatures taken positive */
    double smallest_eigenvalue; /* of the Hessian in parameters scaled to one unit of span length */
    double largest_eigenvalue;
    double defect; /* largest difference between the rows and those rebuilt from their parameters */
    size_t parameters;
} reference_certificate;

typedef struct {
    double start_value, ceres_value, value;
    double finer_value; /* the functional of the same rows by 2 n + 1 points */
    double ceres_gradient;
    int32_t ceres_iterations, newton_iterations;
    int32_t converged; /* a Newton step would gain less than 1e-12 of the value, and no direction has negative curvature */
    int32_t runaway;   /* the curve grew out of all proportion: a minimum at infinity */
    reference_measure measure;
    reference_certificate certificate;
} reference_result;

/* The number of elements of a solution: spans times elements per span. */
size_t reference_element_count(const reference_problem *problem);

/* Rows of the start by thesis 4.9. */
int32_t reference_start(const reference_problem *problem, double *rows, char *message);

/* Minimises from `start_rows`, or from thesis 4.9 when that is NULL. */
int32_t reference_solve(const reference_problem *problem, const reference_options *options, const double *start_rows,
                        double *rows, reference_result *result, char *message);

/* Measures any rows. Sums are taken in long double. */
int32_t reference_evaluate(const double *rows, size_t element_count, int32_t planar, int32_t points,
                           reference_measure *measure, char *message);

/* Projects rows onto the parameters and says how stationary they are. */
int32_t reference_certify(const reference_problem *problem, const double *rows, reference_certificate *certificate,
                          char *message);

/* Value and gradient at the rows' parameters plus `offset` (NULL: no offset). With `gradient` NULL only the value. At most
 * 18 parameters an element are written; `parameter_count` says how many. */
int32_t reference_gradient(const reference_problem *problem, const double *rows, const double *offset, double *value,
                           double *gradient, size_t *parameter_count, char *message);

#ifdef __cplusplus
}
#endif
#endif
