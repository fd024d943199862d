//! Settings that tune the searches of the space-time planner.
//!
//! Each is a number that changes which plans are found, or how long that takes, and never whether a plan is
//! clear: tolerances and sampling intervals of tests stay beside the test. [`SpaceTimeSettings::DEFAULT`] is what
//! plans are made with. Others serve ablations: `campaign … --set group.name=value` (docs/reference/development.md).
//!
//! Metres and seconds of searches without rules and land are those of the normalised problem, whose turning
//! radius is `size.turn_m` unless the first set met is very small or large.

use crate::SearchKind;

/// Structs of settings with a default each, so that a value appears next to its meaning.
macro_rules! settings {
    ($($(#[$of:meta])* $group:ident { $($(#[$doc:meta])* $name:ident: $kind:ty = $value:expr,)* })*) => {$(
        $(#[$of])*
        #[derive(Debug, Clone, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
        pub struct $group { $($(#[$doc])* pub $name: $kind,)* }

        impl $group {
            /// The settings that plans are made with.
            pub const DEFAULT: Self = Self { $($name: $value,)* };
        }

        impl Default for $group {
            fn default() -> Self {
                Self::DEFAULT
            }
        }
    )*};
}

settings! {
    /// Settings of the space-time planner, in the order in which they come into play.
    SpaceTimeSettings {
        /// Size of normalised problems.
        size: SizeSettings = SizeSettings::DEFAULT,
        /// Route along the desired path.
        route: RouteSettings = RouteSettings::DEFAULT,
        /// Conflicts of the nominal motion.
        conflicts: ConflictSettings = ConflictSettings::DEFAULT,
        /// Graph of tangent segments.
        graph: GraphSettings = GraphSettings::DEFAULT,
        /// Budgets by the number of targets.
        budgets: BudgetSettings = BudgetSettings::DEFAULT,
        /// Predefined manoeuvres.
        guesses: GuessSettings = GuessSettings::DEFAULT,
        /// Coarse grid and hybrid A*.
        grid: GridSettings = GridSettings::DEFAULT,
        /// Refinement of a manoeuvre.
        refinement: RefinementSettings = RefinementSettings::DEFAULT,
        /// Insertion of segment variables.
        insertion: InsertionSettings = InsertionSettings::DEFAULT,
        /// Tidy plans.
        tidy: TidySettings = TidySettings::DEFAULT,
        /// Graph of manoeuvres by the rules.
        rules: RuleSettings = RuleSettings::DEFAULT,
    }

    /// Size of normalised problems: that of a harbour vessel.
    SizeSettings {
        /// Turning radius, m.
        turn_m: f64 = 100.0,
        /// Desired speed, m/s.
        speed_mps: f64 = 5.0,
        /// Where the first set met has a radius at contact below `smallest_m` or above `largest_m`, m, the size
        /// follows from that set.
        smallest_m: f64 = 10.0,
        /// See `smallest_m`.
        largest_m: f64 = 210.0,
        /// Radius of such a set, m.
        set_m: f64 = 43.0,
    }

    /// Route along the desired path. A desired speed that own ship does not have is mixed from a faster and a
    /// slower one.
    RouteSettings {
        /// Distance between two returns to schedule, m.
        alternation_m: f64 = 130.0,
        /// Least length of the faster part, m, because a speed very close to own ship's would otherwise be
        /// mixed from thousands of parts.
        least_alternation_m: f64 = 17.0,
        /// `alternation_m` of a tidy plan, m.
        tidy_alternation_m: f64 = 400.0,
        /// `least_alternation_m` of a tidy plan, m.
        tidy_least_alternation_m: f64 = 50.0,
        /// Most alternations on one piece, about: with hundreds the refinement is slow.
        most_alternations: f64 = 50.0,
    }

    /// Conflicts of the nominal motion.
    ConflictSettings {
        /// Conflicts that all begin within this time are left to one manoeuvre, s.
        apart_s: f64 = 120.0,
        /// Largest lead of a departure before a conflict, s.
        lead_s: f64 = 67.0,
        /// Time after the beginning of a conflict until which its plan is clear of all sets, s. Sets that are met
        /// later are the next conflict.
        clear_s: f64 = 100.0,
    }

    /// Graph of tangent segments.
    GraphSettings {
        /// Times before the first contact at which a manoeuvre may begin, besides t = 0, s.
        leads_s: [f64; 5] = [8.0, 18.0, 30.0, 50.0, 80.0],
        /// Contacts that begin within this time of another are one, s.
        contacts_apart_s: f64 = 50.0,
        /// Largest turn toward a vertex, rad.
        max_turn: f64 = 2.0,
        /// Largest duration of an interception, s.
        max_interception_s: f64 = 240.0,
        /// Times for which a course is held beyond a vertex, one after another, s.
        holds_s: [f64; 3] = [20.0, 40.0, 80.0],
        /// Angles between the return lines and the route, rad.
        return_angles: [f64; 2] = [0.4, 0.8],
        /// Largest number of consecutive vertices.
        max_chain: u8 = 5,
        /// Largest number of vertices of an initial set whose moving vertices are nodes. Larger sets are
        /// simplified first.
        initial_vertices: usize = 24,
        /// Largest number of vertices of a velocity set whose moving vertices are nodes.
        velocity_vertices: usize = 12,
        /// Obstacles farther than this from the nominal motion get no nodes, m.
        relevant_m: f64 = 120.0,
        /// Blocks of land farther than this from it get no tangent edges, m.
        land_m: f64 = 40.0,
        /// Largest number of vertices of a block whose corners are nodes.
        block_vertices: usize = 8,
    }

    /// Budgets by the number of targets.
    BudgetSettings {
        /// For one target: finds the graph's optimum.
        one_target: SearchBudget = ONE_TARGET,
        /// For several targets. A search takes longer, and predefined manoeuvres around one conflict are less often
        /// clear of all; the coarse search finds what they miss. A graph plan that is not optimal is usually as good
        /// an initial guess. The first stage is short; the later ones weight the heuristic less.
        several_targets: SearchBudget = SEVERAL_TARGETS,
        /// For some of several targets, which are resolved one after another.
        part_of_several: SearchBudget = SearchBudget { searches_grid: false, ..SEVERAL_TARGETS },
        /// For a thorough search among several targets.
        thorough: SearchBudget = SearchBudget {
            stages: [(2_000, 1.0), (4_000, 1.5), (4_000, 1.5)],
            dead_ends: 4,
            more_conflicts: 4,
            ..SEVERAL_TARGETS
        },
        /// For a warm start. A manoeuvre that is clear of other sets is clear of these soon or never.
        warm_start: SearchBudget = SearchBudget {
            max_iterations: 16,
            iterations_once_clear: 5,
            leaders: 1,
            ..ONE_TARGET
        },
    }

    /// Predefined manoeuvres.
    GuessSettings {
        /// Ratio of the distance sailed in a conflict to its offset from which the manoeuvres for slender ones are tried.
        slender_from: f64 = 2.5,
        /// Largest number of conflicts with manoeuvres of their own, earliest first.
        max_conflicts: usize = 2,
        /// Largest number of ways past the sets, where others than the cheapest are asked for.
        most_ways: usize = 5,
        /// Relative cost difference below which two motions with the same first turn are the same way.
        same_way: f64 = 0.02,
        /// Return angles, rad; the smallest that fits is used.
        return_angles: [f64; 4] = [0.3, 0.5, 0.8, 1.1],
    }

    /// Coarse grid and hybrid A*.
    GridSettings {
        /// Iterations of the refinement of a path of the grid.
        iterations: usize = 24,
        /// Corners nearer to the simplified path than this are left out of a path of the grid, in cells.
        grid_tolerance: f64 = 1.0,
        /// Corners nearer to the simplified path than this are left out of a path of the hybrid A*, in cells.
        hybrid_tolerance: f64 = 0.6,
        /// Factor of the tolerance while too many corners remain.
        coarser: f64 = 1.3,
        /// A hybrid A* motion is kept up to this multiple of the best candidate's cost, because refinement typically
        /// saves a third.
        of_use: f64 = 1.5,
        /// Cost below which the grid is too coarse for the hybrid A* to find a cheaper plan, in squared cells.
        too_cheap: f64 = 0.01,
        /// Cells by which sets are smaller in a second grid: half a cell closes no gap that is there.
        smaller: f64 = 0.5,
        /// Turns of the motion primitives, rad.
        turns: [f64; 7] = [0.0, 0.25, -0.25, 0.6, -0.6, 1.4, -1.4],
        /// Largest number of speeds: the memory of the search grows with it.
        most_speeds: usize = 6,
        /// Courses that are distinguished at one position and time.
        courses: f64 = 12.0,
        /// Heuristic weight (weighted A*): slightly dearer plans for a fraction of the expansions.
        weight: f64 = 1.1,
    }

    /// Refinement of a manoeuvre.
    RefinementSettings {
        /// First trust region of the lengths, m.
        first_radius_m: f64 = 80.0,
        /// Largest trust region, m.
        largest_radius_m: f64 = 400.0,
        /// Smallest trust region, m.
        smallest_radius_m: f64 = 0.02,
        /// Largest number of restoration steps for a result slightly inside a set.
        restorations: usize = 3,
        /// Largest depth in a set that is restored, m.
        restorable_m: f64 = 5.0,
        /// Longest turn of one segment variable in a step, rad. With a small turning radius a step of some
        /// metres would be thousands of turns, each with its closest approaches.
        longest_arc: f64 = 2.0,
        /// Least penalty of a missing metre, m²/m.
        least_penalty: f64 = 10.0,
        /// Its part that grows with the cost of the initial guess, 1/m. Later the penalty is at least the sum of
        /// the multipliers.
        penalty_per_cost: f64 = 0.01,
        /// Factor of the penalty for a refinement that has converged inside a set.
        penalty_factor: f64 = 6.0,
        /// Largest number of such increases.
        max_raises: usize = 3,
        /// Factor of a step that does not fit or gain.
        backtrack: f64 = 0.4,
        /// Largest number of them. Then the programme is solved again in a smaller trust region.
        max_backtracks: usize = 2,
        /// Fraction of the attainable change that an unsatisfiable row requires.
        attainable: f64 = 0.8,
        /// Least ratio of actual to predicted gain of a step.
        least_gain: f64 = 0.05,
        /// Relative decrease that counts as no progress.
        stalled: f64 = 1e-3,
        /// Largest number of steps of a refinement, whatever its budget. It should be more than `fine_from`, because
        /// only a manoeuvre with fine chords counts as clear.
        max_steps: usize = 40,
        /// Longest arc per chord in the search for approaches at first, rad.
        coarse_chord: f64 = 0.15,
        /// Number of rounds after which chords are fine.
        fine_from: usize = 6,
    }

    /// Insertion of segment variables.
    InsertionSettings {
        /// Shorter segment variables are removed before the insertion, m.
        empty_m: f64 = 0.5,
        /// Least useful turn, rad.
        least_turn: f64 = 0.03,
        /// Least useful line, in turning radii.
        least_line: f64 = 0.05,
        /// Largest change of a length in the step that prices the contacts, m.
        pricing_radius_m: f64 = 20.0,
        /// Largest number of insertions at a time.
        max_insertions: usize = 8,
        /// Least predicted gain of the insertions, as a fraction of the cost.
        min_predicted_gain: f64 = 1e-3,
        /// Length above which lines are divided before the insertion, m.
        uncut_m: f64 = 200.0,
        /// Iterations of a refinement after an insertion.
        iterations: usize = 8,
        /// Relative cost that pruning may add.
        pruning_cost: f64 = 2e-3,
        /// Iterations of a refinement after the final pruning.
        iterations_after_pruning: usize = 6,
    }

    /// Tidy plans.
    TidySettings {
        /// Price of a change of speed or a turn, as a fraction of the cost.
        price: f64 = 0.05,
        /// Price of each of them that is one too many, and of a segment or a time at a speed that is too short.
        excess_price: f64 = 6.0,
        /// Largest number of these that is counted: a long voyage may need many, and a tidy plan must not cost a
        /// multiple without limit.
        most_excess: usize = 2,
        /// Most changes of speed of a manoeuvre.
        most_speed_changes: usize = 3,
        /// Most turns of a manoeuvre.
        most_turns: usize = 4,
        /// Least change of speed that is counted, as a fraction of own speed.
        speed_change: f64 = 0.02,
        /// Least turn that is counted, rad (2°).
        turn: f64 = std::f64::consts::PI / 90.0,
        /// Fraction of the least time below which a segment variable is dropped, not prolonged. Also the fraction
        /// of the least time at a speed below which less speed is given up.
        dropped: f64 = 0.5,
        /// Number of manoeuvres that are simplified.
        leaders: usize = 2,
        /// Relative cost difference up to which they are.
        leader_margin: f64 = 0.5,
        /// Simplifying stops when a tidy candidate costs, with its price, at most this multiple of the refinement:
        /// the price of seven alterations, as many as a tidy plan has.
        enough: f64 = 1.35,
        /// Iterations of a refinement after simplifying.
        iterations: usize = 12,
    }

    /// Graph of manoeuvres by the rules.
    RuleSettings {
        /// Time in which a harbour vessel sails its turning radius, s. Where own ship takes longer, the times between
        /// departures, of parallel courses and of the pattern search grow as much.
        turn_s: f64 = 20.0,
        /// First turns, as multiples of the least readily apparent turn of 30°.
        turns: [f64; 6] = [1.0, 1.5, 2.2, 3.0, 4.0, 5.0],
        /// First turns from a given departure, as multiples of 30°.
        all_turns: [f64; 10] = [1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5],
        /// First turns without roles, as multiples of 30°.
        plain_turns: [f64; 4] = [0.3, 0.8, 1.5, 3.0],
        /// Least turn without roles, rad.
        plain_turn: f64 = std::f64::consts::PI / 60.0,
        /// Greatest lower speed without roles, as a fraction of the ordered one.
        plain_slow: f64 = 0.98,
        /// Largest first turn, rad: with a little more own ship would turn about.
        largest_turn: f64 = 3.0,
        /// Largest turn toward the last waypoint, rad: with more own ship would circle.
        largest_last: f64 = 2.5,
        /// Time of the least segment of a manoeuvre, s.
        least_s: f64 = 3.0,
        /// Ratio of the costs above which less speed replaces a turn, Rule 8(c).
        speed_price: f64 = 2.0,
        /// Own ship may follow a target that it does not pass where no more than this is left of the route at the first
        /// contact, in turning radii. On a longer route it passes.
        follow_radii: f64 = 12.0,
        /// Ratio of the costs above which own ship is on time again by a change of speed that is too short.
        short_price: f64 = 2.0,
        /// Most departures.
        most_departures: usize = 6,
        /// Least time between two departures, s: in a short window they differ little.
        departures_apart_s: f64 = 8.0,
        /// Time within which the first alteration follows a risk that begins late, s.
        react_s: f64 = 20.0,
        /// Time within which a ship that overtakes alters, s: once it has turned, the closest approach comes early.
        overtaking_react_s: f64 = 10.0,
        /// Times for which a parallel course stays clear after the targets are passed, s: more is wider, with more
        /// room to return.
        room_s: [f64; 4] = [0.0, 6.0, 30.0, 150.0],
        /// Angles between the return line and the route, rad.
        angles: [f64; 3] = [0.35, 0.65, 1.05],
        /// Departures whose line hugs a body, for each course.
        hugging_departures: usize = 3,
        /// Most goals whose rules the judges are asked for.
        most_goals: usize = 6,
        /// Most expanded nodes of one search.
        most_expanded: usize = 4_000,
        /// Rounds of the pattern search.
        rounds: usize = 7,
        /// Its first steps: of the departure, s; of the turn and of the angle of the return, rad; and of the time by
        /// which a parallel course is wider, s.
        steps: [f64; 4] = [10.0, 0.15, 0.2, 30.0],
        /// Least and greatest angle of the return that the pattern search may try, rad.
        angle_range: [f64; 2] = [0.1, 1.4],
        /// Largest turn of an escape, rad: a turn about at the last moment is none.
        largest_escape: f64 = std::f64::consts::FRAC_PI_2 + 1e-9,
        /// Sampled instants of the escape of a stand-on ship.
        escape_samples: usize = 40,
        /// Time by which a stand-on ship acts before the latest certified escape, s.
        spare_s: f64 = 40.0,
        /// Ratio of the cost of an escape to that of a manoeuvre from when own ship may act: one that is dearer is
        /// no escape.
        late_price: f64 = 4.0,
        /// Range within which a stand-on ship acts, in lengths.
        act_lengths: f64 = 6.0,
        /// Highest ratio of *J* to the cheapest plan's that is accepted to avoid breaking a rule. *J* is quadratic,
        /// so this is ten times the deviation; beyond it no one would sail the plan, such as one manoeuvre around
        /// ships that are met an hour apart.
        most_cost_ratio: f64 = 100.0,
        /// Highest such ratio for a plan that still breaks some rules, though fewer than the cheapest, because one rule
        /// fewer of many hardly makes a better plan.
        most_unlawful_cost_ratio: f64 = 1.5,
        /// Most expanded groups of targets: so many for each target, and as many again.
        groups_per_target: usize = 3,
        /// Most plans of groups whose rules are judged.
        most_plans: usize = 24,
    }
}

impl BudgetSettings {
    /// Budget for the given number of targets, which may be some of all.
    pub(crate) const fn of(
        &self,
        targets: usize,
        is_part: bool,
        search: SearchKind,
    ) -> &SearchBudget {
        match (targets, search) {
            (0 | 1, _) => &self.one_target,
            (_, SearchKind::Thorough) => &self.thorough,
            _ if is_part => &self.part_of_several,
            _ => &self.several_targets,
        }
    }
}

/// Computational budget of the search and the refinement.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct SearchBudget {
    /// `(max_expansions, heuristic_weight)` of each search stage. The limit counts all expansions so far and
    /// bounds memory and time. A stage starts where the earlier ones found no plan; a stage that repeats the one
    /// before does nothing.
    pub stages: [(usize, f64); 3],
    /// Largest number of iterations of a refinement.
    pub max_iterations: usize,
    /// Largest number of iterations once some manoeuvre is clear, because the best one then lacks segment variables
    /// rather than iterations.
    pub iterations_once_clear: usize,
    /// Iterations after which only the guesses with the lowest cost plus penalty continue.
    pub race_from: usize,
    /// Number of those that continue. The others do only where none of these becomes clear.
    pub racers: usize,
    /// Largest number of manoeuvres that get segment insertions.
    pub leaders: usize,
    /// Relative cost difference from the best one up to which a manoeuvre gets them.
    pub leader_margin: f64,
    /// True where a coarse grid is searched, too.
    pub searches_grid: bool,
    /// Where conflicts are resolved one after another: largest number of motions that have no way past their next
    /// conflict.
    pub dead_ends: usize,
    /// Largest number of conflicts that are resolved once a motion is clear of all, for a cheaper one.
    pub more_conflicts: usize,
}

const ONE_TARGET: SearchBudget = SearchBudget {
    stages: [(2_000, 1.0); 3],
    max_iterations: 40,
    iterations_once_clear: 8,
    race_from: 5,
    racers: 4,
    leaders: 3,
    leader_margin: 0.3,
    searches_grid: false,
    dead_ends: 3,
    more_conflicts: 3,
};

const SEVERAL_TARGETS: SearchBudget = SearchBudget {
    stages: [(20, 1.0), (200, 4.0), (1_300, 2.5)],
    searches_grid: true,
    ..ONE_TARGET
};
