// Quantiles for two-sided confidence intervals.
#pragma once

namespace hemibake {

// Returns z with P(|Z| ≤ z) = confidence for a standard normal Z. confidence: in (0, 1).
double normal_quantile(double confidence);

// Returns t with P(|T| ≤ t) = confidence for Student's T; infinite below one degree of freedom.
// degrees_of_freedom: not necessarily whole.
double student_quantile(double confidence, double degrees_of_freedom);

}  // namespace hemibake
