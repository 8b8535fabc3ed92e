cdef class Options:
    pass

cdef class NewtonOptions(Options):
    cdef readonly int max_iterations, max_chord_steps, max_cheap_chord_steps, half_steps
    cdef readonly double max_step, tolerance, preliminary_tolerance, final_step, negligible_step, stalled_rounding, growing_rounding, chord_step, chord_contraction, cheap_chord_contraction, last_chord_step, max_growth, divergence_ratio
    cdef readonly double rounding_ratio, max_second_ratio, small_second_step, max_rounding, rounding_multiple

cdef class StepOptions(Options):
    cdef readonly double initial_step, min_step, min_cosine, min_cubic_cosine, any_turn_step, max_branch_distance, max_miss, target_turn, target_miss, target_output_error, max_output_error_ratio, min_factor, max_factor
    cdef readonly double max_factor_hasty, safety, step_after_corner, resumed_fraction, retry_fraction
    cdef readonly int max_steps
    cdef readonly tuple retreats

cdef class EventOptions(Options):
    cdef readonly int max_evaluations, many_outputs
    cdef readonly double peak_tolerance, peak_tolerance_of_many, tolerance, fold_bracket, min_growth, peak_threshold, max_slope_change, doubtful_slope, min_reversal, rounding_step, point_tolerance, far_tolerance, repeat_tolerance, around_cosine, closing_cosine, landing_tolerance

cdef class SwitchingOptions(Options):
    cdef readonly int max_predictions, departure_tries, max_pieces, many_unknowns
    cdef readonly double distance_tolerance, label_tolerance, overshoot, crossing_factor, root_fraction, reached_distance_root, root_distance, root_difference, root_separation, max_root_margin, smooth_fraction, reached_distance, turning_distance, approach_distance, approach_fraction, departure_length, max_deviation

cdef class FollowOptions(Options):
    cdef readonly double max_step
    cdef readonly bint user_points_only
    cdef readonly NewtonOptions newton
    cdef readonly StepOptions step
    cdef readonly EventOptions events
    cdef readonly SwitchingOptions switching
    cdef readonly object labels
