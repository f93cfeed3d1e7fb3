//! Tests of fleets.
