//! Why a suite cannot measure.

/// Why a suite, or a scene of one, cannot be measured: a sentence, of what failed first.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct BenchError(String);

impl From<String> for BenchError {
    fn from(sentence: String) -> Self {
        Self(sentence)
    }
}

impl From<&str> for BenchError {
    fn from(sentence: &str) -> Self {
        Self(sentence.to_owned())
    }
}
