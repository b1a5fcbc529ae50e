// Quantiles for two-sided confidence intervals.
#pragma once

namespace hemibake {

// z with P(|Z| ≤ z) = confidence for a standard normal Z; confidence in (0, 1).
double normal_quantile(double confidence);

// t with P(|T| ≤ t) = confidence for Student's T with `degrees_of_freedom` ≥ 1, not necessarily whole. To 0.2
// % from 5 degrees of freedom at confidence up to 0.99; infinite below 1.
double student_quantile(double confidence, double degrees_of_freedom);

}  // namespace hemibake
