//! Random points of one metric.
