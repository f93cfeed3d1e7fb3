//! How long a random scene may take.

use std::time::{Duration, Instant};

/// Time that a scene may take.
const LIMIT: Duration = Duration::from_secs(10);

/// Fails where it is dropped if its scene took too long.
pub struct InTime(Instant);

impl InTime {
    pub fn begin() -> Self {
        Self(Instant::now())
    }
}

impl Drop for InTime {
    fn drop(&mut self) {
        let took = self.0.elapsed();
        assert!(took < LIMIT || std::thread::panicking(), "a scene took {took:?}");
    }
}
