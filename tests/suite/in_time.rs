//! How much work a random scene may take: seconds of a processor, which other programs on the machine do not add to.

/// Seconds of one processor that a scene may take: a thousand times what scenes take.
const LIMIT: f64 = 10.0;

/// Fails where it is dropped if the thread has worked too long since it was made.
pub struct InTime(f64);

impl InTime {
    pub fn begin() -> Self {
        Self(worked())
    }
}

impl Drop for InTime {
    fn drop(&mut self) {
        let took = worked() - self.0;
        assert!(took < LIMIT || std::thread::panicking(), "a scene took {took} s of a processor");
    }
}

/// Seconds for which this thread has had a processor; 0 where the system does not tell.
fn worked() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split_whitespace().next().and_then(|word| word.parse::<f64>().ok());
    nanoseconds.map_or(0.0, |nanoseconds| 1e-9 * nanoseconds)
}
