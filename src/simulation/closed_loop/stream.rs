//! Streams of random numbers, each of its own, so that another target changes no other's.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

#[derive(Debug, Clone, Copy)]
pub(super) enum Purpose {
    Behaviour,
    Sensor,
    Current,
}

/// The stream of a seed for a purpose and a name (FNV-1a hash).
pub(super) fn stream(seed: u64, purpose: Purpose, name: &str) -> ChaCha8Rng {
    let start = 0xcbf2_9ce4_8422_2325_u64 ^ purpose as u64;
    let hash = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(
        name.bytes()
            .fold(start.wrapping_mul(0x0100_0000_01b3), hash),
    );
    rng
}

/// A normal random number with mean 0 and standard deviation 1 (Box and Muller).
pub(super) fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    radius * (std::f64::consts::TAU * rng.random::<f64>()).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_by_seed_purpose_and_name_and_are_normal() {
        let first = |seed, purpose, name| stream(seed, purpose, name).random::<u64>();
        let all = [
            first(1, Purpose::Sensor, "a"),
            first(2, Purpose::Sensor, "a"),
            first(1, Purpose::Behaviour, "a"),
            first(1, Purpose::Current, "a"),
            first(1, Purpose::Sensor, "b"),
        ];
        let different: std::collections::BTreeSet<u64> = all.into_iter().collect();
        assert_eq!(different.len(), all.len());
        let mut rng = stream(1, Purpose::Sensor, "a");
        let drawn: Vec<f64> = (0..20_000).map(|_| normal(&mut rng)).collect();
        let mean = drawn.iter().sum::<f64>() / 2e4;
        let variance = drawn.iter().map(|x| x * x).sum::<f64>() / 2e4;
        assert!(mean.abs() < 0.03 && (variance - 1.0).abs() < 0.05);
    }
}
