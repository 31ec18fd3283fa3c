//! The layout of every struct of the interface on machines of 64 bits, fixed for good with [`crate::MINVAR_ABI`].
//!
//! Here the Rust compiler holds the structs to these figures, in `tests/c/layout.c` the C compiler does: a figure that
//! changes is another interface.

/// `struct { field: offset, … } size`
macro_rules! layout {
    ($($name:ident { $($field:ident: $offset:literal),* } $size:literal)*) => {
        #[cfg(target_pointer_width = "64")]
        const _: () = {
            $(
                $(assert!(core::mem::offset_of!(crate::$name, $field) == $offset);)*
                assert!(size_of::<crate::$name>() == $size);
            )*
        };
    };
}

layout! {
    minvar_error { code: 0, index: 8, needed: 16, given: 24, message: 32 } 224
    minvar_quantity { given: 0, value: 8 } 32
    minvar_joint { continuity: 0, position: 8, tangent: 40, curvature: 104, guide: 168 } 192
    minvar_obstacle { from: 0, to: 24, clearance: 48, side: 56 } 64
    minvar_curve { joints: 0, joint_count: 8, closed: 16, reference: 24, reference_count: 32, reference_weight: 40, obstacles: 48, obstacle_count: 56 } 64
    minvar_options { functional: 0, elements_per_span: 4, quadrature_points: 8, max_iterations: 12, dimension: 16, continuation: 20, relative_decrease: 24, tension: 32, bending: 40, length: 48, tolerance: 56 } 64
    minvar_element { rows: 0 } 144
    minvar_record { value: 0, predicted: 8, actual: 16, gradient: 24, step: 32, shift: 40 } 48
    minvar_report { status: 0, planar: 4, elements: 8, iterations: 16, linearisations: 24, unknowns: 32, value: 40, fine_value: 48, length: 56, variation: 64, bending: 72, error: 80, gradient: 88, decrement: 96 } 104
    minvar_point { element: 0, parameter: 8, arc_length: 16, point: 24, tangent: 48, curvature: 72, signed_curvature: 96, curvature_derivative: 104, torsion: 112 } 120
    minvar_figures { length: 0, variation: 8, bending: 16, least_curvature: 24, largest_curvature: 144, box_low: 264, box_high: 288 } 312
    minvar_move { turn: 0, end: 8, centre: 32, deviation: 56 } 64
    minvar_gcode_options { tolerance: 0, feed: 8, plunge_feed: 16, safe_height: 24, depth: 32, units: 40, plane: 44, motion: 48, decimals: 52, comments: 56 } 64
    minvar_gcode_summary { lines: 0, arcs: 8, chords: 16, length: 24, minutes: 32, deviation: 40 } 48
}
