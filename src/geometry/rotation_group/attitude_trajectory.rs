//! Attitude trajectories: quaternions at given times, and Euler angles with continuous branches for reading and plotting.
//!
//! Four equations, [`super::attitude_route::AttitudeFlow`]: no tangent, no event. Angles come from the quaternion by
//! `atan2`; between samples their branches are followed along the step's polynomials, as finely as the distance to the
//! chart's poles asks for, so no turn is lost however far apart the samples are. Units: radians. Not known here:
//! conjugate times.

use crate::geometry::rotation_group::attitude_route::{AttitudeFlow, to_body, to_space};
use crate::geometry::rotation_group::euler_angles::{ChartError, EulerPoint, SMALLEST_SINE, angles_near};
use crate::geometry::rotation_group::metric::{DomainError, Metric, check_momentum};
use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::taylor::dense::sample;
use crate::numerics::taylor::integrator::{IntegrationError, Observer, Settings, Step, integrate};
use std::ops::ControlFlow;

/// Attitude and momentum at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude<S> {
    /// The unit quaternion.
    pub quaternion: [S; 4],
    /// The angular momentum in the body frame.
    pub body_momentum: [S; 3],
}

/// Why an attitude trajectory could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AttitudeError {
    /// Metric or momentum outside the domain.
    #[error(transparent)]
    Domain(#[from] DomainError),
    /// Euler angles are not defined somewhere on the way.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// The integration failed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
}

/// Attitude and body momentum at the given times (any order, negative too), from a unit quaternion and a body momentum.
///
/// Base flow alone, four equations. Guarantee: at `tolerance = ε` rounding only, growing linearly in time.
///
/// # Errors
/// [`AttitudeError`]: domain, integration.
pub fn attitude_at<S: Real>(
    metric: &Metric<S>,
    quaternion: [S; 4],
    body_momentum: [S; 3],
    times: &[S],
    tolerance: f64,
) -> Result<(Vec<Attitude<S>>, Work), AttitudeError> {
    check_momentum(&body_momentum)?;
    let space_momentum = to_space(&quaternion, &body_momentum);
    let flow = AttitudeFlow { inverse_inertia: metric.inverse_inertia(), space_momentum };
    let (states, work) = sample(&flow, &quaternion, S::ZERO, times, &Settings::new(tolerance))?;
    let read = |q: [S; 4]| Attitude { quaternion: q, body_momentum: to_body(&q, &space_momentum) };
    Ok((states.into_iter().map(read).collect(), work))
}

/// Follows σ = (Φ1+Φ3)/2 and δ = (Φ1−Φ3)/2 along the planar curves (w, z) and (y, −x), from one point to the next no
/// farther than half the distance to the origin: no branch can be lost.
struct EulerBranches<'t, S: Real> {
    times: &'t [S],
    current: [S; 3],
    angles: Vec<[S; 3]>,
    failure: Option<ChartError>,
}

impl<S: Real> EulerBranches<'_, S> {
    fn follow(&mut self, step: &Step<'_, S, AttitudeFlow<S>>, work: &mut Work) -> Result<ControlFlow<()>, ChartError> {
        // A bound of |dq/dt| on the step, per component pair: Σ n |c_n| h^(n−1).
        let length = step.length.abs();
        let mut speed = S::ZERO;
        for series in &step.jet.state {
            let mut sum = S::ZERO;
            for n in (1..=step.jet.order()).rev() {
                sum = sum * length + S::from_f64(n as f64) * series[n].abs();
            }
            speed = speed.max(sum);
        }
        let direction = if step.length < S::ZERO { -S::ONE } else { S::ONE };
        let mut offset = S::ZERO;
        loop {
            let [w, x, y, z] = step.state(offset);
            work.dense_points += 1;
            let distance = (w * w + z * z).min(x * x + y * y).sqrt();
            if (distance + distance).to_f64() < SMALLEST_SINE {
                let phi2 = 2.0 * libm::atan2((x * x + y * y).sqrt().to_f64(), (w * w + z * z).sqrt().to_f64());
                let (sine, time) = (2.0 * distance.to_f64(), Some(step.time(offset).to_f64()));
                return Err(ChartError::Pole { phi2, sine, time });
            }
            self.current = angles_near(&[w, x, y, z], &self.current)?;
            // Times up to the next point: each is within half the distance to the origin too.
            let reach = distance / (S::from_f64(3.0) * speed);
            let next = (offset.abs() + reach).min(length);
            while let Some(&time) = self.times.get(self.angles.len()) {
                let ahead = ((time - step.start.value) - step.start.rest) * direction;
                if ahead > next {
                    break;
                }
                work.dense_points += 1;
                self.angles.push(angles_near(&step.state(ahead * direction), &self.current)?);
            }
            if self.angles.len() == self.times.len() {
                return Ok(ControlFlow::Break(()));
            }
            if offset.abs() >= length {
                return Ok(ControlFlow::Continue(()));
            }
            offset = next * direction;
        }
    }
}

impl<S: Real> Observer<S, AttitudeFlow<S>> for EulerBranches<'_, S> {
    fn observe(&mut self, step: &Step<'_, S, AttitudeFlow<S>>, work: &mut Work) -> ControlFlow<()> {
        match self.follow(step, work) {
            Ok(flow) => flow,
            Err(error) => {
                self.failure = Some(error);
                ControlFlow::Break(())
            }
        }
    }
}

/// Φ1, Φ2, Φ3 at the given times, continuous from the start (no jumps by 2π), times in increasing order from zero on.
///
/// Source: quaternion trajectory, `atan2`, branches followed between the samples as finely as the motion asks for.
///
/// # Errors
/// [`AttitudeError`]: domain; a pole on the way, with its time; times that are not ordered; integration.
pub fn euler_angles_at<S: Real>(
    metric: &Metric<S>,
    start: &EulerPoint<S>,
    times: &[S],
    tolerance: f64,
) -> Result<(Vec<[S; 3]>, Work), AttitudeError> {
    let body_momentum = start.body_momentum()?;
    check_momentum(&body_momentum)?;
    let mut before = S::ZERO;
    for &time in times {
        let ordered = time >= before;
        if !ordered {
            let (name, accepted) = ("time", "times must be ordered and not before the start");
            return Err(DomainError { name, value: time.to_f64(), accepted }.into());
        }
        before = time;
    }
    let quaternion = start.attitude();
    let space_momentum = to_space(&quaternion, &body_momentum);
    let flow = AttitudeFlow { inverse_inertia: metric.inverse_inertia(), space_momentum };
    let Some(&end) = times.last() else { return Ok((Vec::new(), Work::default())) };
    let angles = Vec::with_capacity(times.len());
    let mut branches = EulerBranches { times, current: start.angles, angles, failure: None };
    let arrival = integrate(&flow, &quaternion, (S::ZERO, end), &Settings::new(tolerance), &mut branches)?;
    if let Some(error) = branches.failure {
        return Err(error.into());
    }
    // A span that ends at its start has no step.
    branches.angles.resize(times.len(), start.angles);
    Ok((branches.angles, arrival.work))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EPSILON: f64 = f64::EPSILON;

    #[test]
    fn quaternions_stay_unit_and_the_body_momentum_follows_euler() {
        let metric = Metric::new(0.7, 1.1, 1.9).unwrap();
        let q = crate::geometry::rotation_group::euler_angles::quaternion(&[0.3, 1.0, -0.4]);
        let m = [0.6, -0.8, 0.5];
        let (states, work) = attitude_at(&metric, q, m, &[20.0, -1.0, 0.0], EPSILON).unwrap();
        assert_eq!((work.state_dimension, work.tangent_evaluations, work.event_evaluations), (4, 0, 0));
        let flow = crate::geometry::rotation_group::body_flow::BodyFlow { inverse_inertia: [0.7, 1.1, 1.9] };
        let body = integrate(&flow, &m, (0.0, 20.0), &Settings::new(EPSILON), &mut ()).unwrap().state;
        for i in 0..3 {
            // Two independent integrations over some 20 radians.
            assert!((states[0].body_momentum[i] - body[i]).abs() < 300.0 * EPSILON, "{states:?} {body:?}");
            assert!((states[2].body_momentum[i] - m[i]).abs() < 4.0 * EPSILON);
        }
        let [w, x, y, z] = states[0].quaternion;
        assert!((w * w + x * x + y * y + z * z - 1.0).abs() < 60.0 * EPSILON);
    }

    #[test]
    fn euler_angles_are_continuous_and_keep_their_momenta() {
        // Case 1 of section 5.3. The momentum about e3 is p1 = 0 all along: only right angles keep it, as M does not
        // know them. Continuity: |dΦ/dt| ≤ (2 + …)·|Ω|/sin Φ2.
        let metric = Metric::new(1.5, 2.0, 2.8).unwrap();
        let start = EulerPoint { angles: [0.0, 2.8506, -0.32175], momenta: [0.0, 0.0, 0.3155946] };
        let times: Vec<f64> = (0..=600).map(|i| 0.01 * f64::from(i)).collect();
        let (angles, work) = euler_angles_at(&metric, &start, &times, EPSILON).unwrap();
        let m0 = start.body_momentum().unwrap();
        let (states, _) = attitude_at(&metric, start.attitude(), m0, &times, EPSILON).unwrap();
        assert!((0..3).all(|i| (angles[0][i] - start.angles[i]).abs() < 10.0 * EPSILON), "{:?}", angles[0]);
        for i in 0..times.len() {
            let point = EulerPoint::from_body_momentum(angles[i], states[i].body_momentum).unwrap();
            assert!(point.momenta[0].abs() < 200.0 * EPSILON, "{}: {point:?}", times[i]);
            if i > 0 {
                let sine = libm::sin(angles[i][1]).min(libm::sin(angles[i - 1][1]));
                let step = (0..3).map(|j| (angles[i][j] - angles[i - 1][j]).abs()).fold(0.0, f64::max);
                assert!(step < 0.01 * 4.0 * 3.1 / sine, "{}: {step}", times[i]);
            }
        }
        assert_eq!(work.state_dimension, 4);
    }

    #[test]
    fn full_turns_are_counted() {
        // Spherical body turning about the momentum along e3 (p1 = |M|, (4)): Φ1 grows by |M| t for ever, the rest stays.
        let metric = Metric::new(1.0, 1.0, 1.0).unwrap();
        let (phi2, phi3) = (1.1, 0.4);
        let start = EulerPoint { angles: [0.0, phi2, phi3], momenta: [2.0, 0.0, 2.0 * libm::cos(phi2)] };
        let (angles, _) = euler_angles_at(&metric, &start, &[1.0, 10.0, 100.0], EPSILON).unwrap();
        for (t, found) in [1.0, 10.0, 100.0].iter().zip(angles) {
            // q is accurate to ε per radian; angles to 1/sin(Φ2/2) of it.
            assert!((found[0] - 2.0 * t).abs() < 30.0 * EPSILON * (1.0 + t), "{t}: {found:?}");
            assert!((found[1] - phi2).abs() < 30.0 * EPSILON * (1.0 + t) && (found[2] - phi3).abs() < 1e-13 * t);
        }
    }

    #[test]
    fn a_pole_on_the_way_is_said_with_its_time() {
        // Spherical body, momentum along space's e2: Φ2 runs through π/2 … π at t = (π − 1)/|M|.
        let metric = Metric::new(1.0, 1.0, 1.0).unwrap();
        let start = EulerPoint { angles: [0.0, 1.0, 0.0], momenta: [0.0, 2.0, 0.0] };
        let refused = euler_angles_at(&metric, &start, &[3.0], EPSILON);
        match refused {
            Err(AttitudeError::Chart(ChartError::Pole { time: Some(time), .. })) => {
                assert!((time - (std::f64::consts::PI - 1.0) / 2.0).abs() < 1e-7, "{time}");
            }
            other => panic!("{other:?}"),
        }
        let disordered = euler_angles_at(&metric, &start, &[0.2, 0.1], EPSILON);
        assert!(matches!(disordered, Err(AttitudeError::Domain(DomainError { name: "time", .. }))));
    }
}
