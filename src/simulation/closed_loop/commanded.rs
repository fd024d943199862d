//! Own ship under the commands of an outside agent, in place of the planner.

use super::{Active, INSTANT, Simulation};
use crate::colregs::SteadyShip;
use crate::evaluation::least_land_distance;
use crate::frame::{Pose, Vector, heading_of, wrap};
use crate::geometry::Window;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::pipeline;
use crate::scenario::{Fault, Memory, Scenario};
use crate::target::Motion;
use crate::tolerance::{TIME_S, TOUCH_M};
use crate::trajectory::{GroundSegment, Segment, Trajectory};

/// A course and a speed for own ship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command {
    /// Radians.
    pub heading: f64,
    /// m/s.
    pub speed: f64,
}

impl Simulation {
    /// The loop without a planner: own ship holds course and speed until [`Self::command`].
    pub fn commanded(scenario: Scenario) -> Result<Self, Vec<Fault>> {
        if super::is_under_forces(&scenario) {
            let allowed = "\"space-time\": commands are courses and speeds, not forces";
            let found = format!("{:?}", scenario.planner.facts().name);
            return Err(vec![Fault::new("planner.kind", found, allowed)]);
        }
        let mut simulation = Self::begun(scenario, false)?;
        simulation.scenario.simulation.replan_on_events = false;
        simulation.next_cycle = f64::INFINITY;
        simulation.observe();
        Ok(simulation)
    }

    /// From now on own ship turns to a course, the shorter way at its turning radius, and holds
    /// it. The speed changes at once, as in plans. A ship that stops keeps its course.
    ///
    /// The error names what is wrong with the command.
    pub fn command(&mut self, command: Command) -> Result<(), Fault> {
        let wrong =
            |path: &str, found: String, allowed: &str| Err(Fault::new(path, found, allowed));
        if self.next_cycle.is_finite() {
            let allowed = "one that was begun without its planner";
            return wrong("simulation", "one that plans".to_owned(), allowed);
        }
        if !command.heading.is_finite() {
            let allowed = "a finite angle";
            return wrong("course", command.heading.to_string(), allowed);
        }
        let most = self.scenario.own_ship.max_speed();
        if !(0.0..=most).contains(&command.speed) {
            let allowed = format!("0 to {most} m/s");
            return wrong("speed_mps", command.speed.to_string(), &allowed);
        }
        if self.finished() {
            return Ok(());
        }
        if let Ok(trajectory) = Trajectory::new(self.response(command)) {
            self.active = Active {
                start: self.time,
                trajectory,
                previous: None,
                left_out: f64::INFINITY,
                assumed: Vec::new(),
            };
        }
        Ok(())
    }

    /// Own ship's motion under a command until the end of the simulation, from t = 0 now.
    fn response(&self, command: Command) -> Vec<Segment> {
        let (own, left) = (self.own().pose, self.duration - self.time);
        let Command { heading, speed } = command;
        let turn = wrap(heading - own.heading);
        let rate = (speed / self.scenario.own_ship.turning_radius).copysign(turn);
        let turning = turn / rate;
        if !(turning > TIME_S) || speed == 0.0 {
            return vec![Segment::straight(own, 0.0, left, speed)];
        }
        let arc = Segment::new(own, 0.0, turning.min(left), speed, rate);
        let end = Pose::new(arc.end().position, heading);
        let rest = left - turning;
        let straight = (rest > TIME_S).then(|| Segment::straight(end, turning, rest, speed));
        std::iter::once(arc).chain(straight).collect()
    }

    /// For the command that own ship follows, and for each of these: true where own ship is clear
    /// of the hard set of every target that it has seen, and of land, until the end of the
    /// simulation.
    ///
    /// A command is clear where its turn enters no set, and its velocity is in no velocity obstacle
    /// seen from the end of the turn: the contact test of a straight motion
    /// ([`SpaceTimeObstacle::first_contact`]) is the test of that membership. As long as every
    /// target keeps to its set, is seen exactly, and own ship follows its commands, a command that
    /// is clear stays so (docs/guide/closed-loop.md). O(commands × sets).
    pub fn clear_commands(&mut self, commands: &[Command]) -> (bool, Vec<bool>) {
        self.observe();
        let sets = self.hard_sets();
        // all of it: a command may lead anywhere, while a plan ends at the mission's end
        let land = self.around_land.get_or_init(|| {
            let map = self.scenario.land.as_ref().map(|land| &land.map);
            pipeline::land_obstacle(&self.scenario, map.map_or(&[], |map| map.pieces()))
        });
        let is_clear = |segments: &[Segment]| {
            let enters = |set: &Obstacle| set.is_entered(segments, TOUCH_M);
            !sets.iter().any(enters) && !segments.iter().any(|s| land.meets(s, TOUCH_M))
        };
        let in_plan = self.time - self.active.start;
        let present = self.active.trajectory.segments().iter();
        let present = present.filter(|s| s.end_time() > in_plan);
        let present = present.map(|s| s.part(in_plan, s.end_time(), in_plan));
        let present: Vec<Segment> = present.collect();
        let each = commands.iter().map(|c| is_clear(&self.response(*c)));
        (is_clear(&present), each.collect())
    }

    /// The hard sets of the targets that own ship has seen, from t = 0 now.
    fn hard_sets(&mut self) -> Vec<Obstacle> {
        let mut scenario = self.scenario_of_known_targets();
        let known = self.targets.iter_mut().filter(|target| target.is_known());
        for (target, simulated) in scenario.targets.iter_mut().zip(known) {
            let ship = simulated.track.set_at(self.time, 0.0);
            simulated.outside_sets += usize::from(simulated.track.is_broken());
            target.motion = Motion::Ship(ship);
        }
        let own = self.own();
        (scenario.own_ship.pose, scenario.own_ship.speed) = (own.pose, own.speed);
        scenario.time += self.time;
        scenario.horizon = self.duration - self.time;
        scenario.desired = self.scenario.desired.remaining(self.time);
        scenario.memory = Memory::default();
        let sets = pipeline::sets(&scenario).into_iter();
        sets.map(|sets| sets.hard).collect()
    }

    /// The names and the states of the targets that own ship has seen, as it knows them, at this
    /// time.
    pub fn estimates(&self) -> impl Iterator<Item = (&str, SteadyShip)> {
        let known = self.targets.iter().filter(|target| target.is_known());
        known.map(|target| {
            let estimate = target.track.estimate();
            let pose = Pose::new(estimate.position, estimate.heading);
            let ship = SteadyShip::new(pose, estimate.speed);
            (target.name.as_str(), ship.moved(self.time - estimate.time))
        })
    }

    /// True where own hull has touched a target's, or land since `time`.
    pub fn is_contact(&self, since: f64) -> bool {
        if self.targets.iter().any(|t| t.clearance.is_contact()) {
            return true;
        }
        let Some(land) = &self.scenario.land else {
            return false;
        };
        let recent = self
            .sailed
            .iter()
            .filter(|s| s.track.end_time() > since + INSTANT);
        let recent = recent.map(|s| s.part(since, s.track.end_time(), 0.0));
        let recent: Vec<GroundSegment> = recent.collect();
        let own = &self.scenario.own_ship.hull;
        let places = recent
            .iter()
            .flat_map(|s| [s.track.start.position, s.track.end().position]);
        let places: Vec<Vector> = places.collect();
        // an arc is within its own length of its ends
        let length = recent.iter().map(|s| s.track.length()).fold(0.0, f64::max);
        let reach = own.half_diagonal() + length;
        let window = Window::around(&places).filter(|_| reach.is_finite());
        if window.is_some_and(|window| land.map.pieces_within(&window.grown(reach)).is_empty()) {
            return false;
        }
        // negated so that a NaN is a contact
        !recent.is_empty() && !(least_land_distance(land.map.polygons(), &recent, own).0 > 0.0)
    }

    /// Where the desired trajectory has own ship now: place, course and speed.
    pub fn desired(&self) -> SteadyShip {
        let desired = &self.scenario.desired;
        let place = desired.position_at(self.time);
        let legs = desired.legs();
        let leg = legs.partition_point(|leg| leg.end_time() <= self.time);
        let leg = &legs[leg.min(legs.len() - 1)];
        SteadyShip::new(Pose::new(place, heading_of(leg.direction)), leg.speed)
    }

    /// The largest speed of a command, m/s.
    pub fn max_speed(&self) -> f64 {
        self.scenario.own_ship.max_speed()
    }

    /// Seconds from the start to the end of the simulation.
    pub fn duration(&self) -> f64 {
        self.duration
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::radians_from_deg;
    use crate::scenario::Behaviour;

    fn crossing(behaviour: Behaviour) -> Simulation {
        let text = include_str!("../../../scenarios/colregs/give-way.toml");
        let mut scenario = Scenario::parse(text).expect("a scenario");
        scenario.simulation.behaviours = vec![behaviour];
        scenario.simulation.duration = Some(600.0);
        Simulation::commanded(scenario).expect("a scenario for the closed loop")
    }

    /// Without a turn a command is clear exactly where its velocity is outside the velocity obstacle.
    #[test]
    fn straight_commands_are_clear_outside_the_velocity_obstacle() {
        let mut simulation = crossing(Behaviour::Constant);
        let own = simulation.own().pose;
        let obstacle = simulation.hard_sets().remove(0);
        let regions = obstacle.velocity_obstacles(own.position, simulation.duration);
        let regions = regions.expect("polygons");
        let (mut inside, mut outside) = (0, 0);
        for step in 0..=500 {
            let speed = simulation.max_speed() * f64::from(step) / 500.0;
            let heading = own.heading;
            let (_, clear) = simulation.clear_commands(&[Command { heading, speed }]);
            let is_in = regions.iter().any(|r| r.contains(own.ahead() * speed));
            assert_eq!(clear[0], !is_in, "{speed} m/s");
            *(if is_in { &mut inside } else { &mut outside }) += 1;
        }
        assert!(inside > 50 && outside > 50, "{inside} {outside}");
    }

    /// The first clear command is held: it stays clear, whatever the target does within its set.
    #[test]
    fn a_clear_command_stays_clear() {
        let extremes = Behaviour::Extremes {
            every: 20.0,
            factor: 1.0,
        };
        let mut simulation = crossing(extremes);
        let ahead = simulation.own().pose.heading;
        let commands = [0.0, -30.0, -60.0, -90.0].map(|degrees| Command {
            heading: ahead + radians_from_deg(degrees),
            speed: simulation.max_speed(),
        });
        let (held, clear) = simulation.clear_commands(&commands);
        assert!(!held && !clear[0]);
        let first = clear.iter().position(|clear| *clear).expect("one is clear");
        simulation.command(commands[first]).expect("a command");
        while !simulation.finished() {
            assert!(simulation.clear_commands(&[]).0, "{} s", simulation.time());
            simulation.step();
        }
        let sailed = simulation.record();
        assert!(sailed.safe && sailed.targets[0].outside_sets == 0);
        assert!(sailed.targets[0].least_clearance_m > Some(20.0));
        assert_eq!(sailed.duration_s, 600.0);
        let heading = sailed
            .sailed
            .last()
            .expect("segments")
            .track
            .start
            .course_deg;
        assert!(
            (heading - crate::frame::course_deg_from_heading(commands[first].heading)).abs() < 1e-6
        );
    }

    #[test]
    fn wrong_commands_are_named() {
        let mut simulation = crossing(Behaviour::Constant);
        for (heading, speed) in [(f64::NAN, 1.0), (0.0, f64::NAN), (0.0, -1.0), (0.0, 99.0)] {
            assert!(simulation.command(Command { heading, speed }).is_err());
        }
        let scenario = simulation.scenario.clone();
        let mut planned = Simulation::new(scenario, false).expect("a scenario");
        let (heading, speed) = (0.0, 1.0);
        assert!(planned.command(Command { heading, speed }).is_err());
    }
}
