//! Land of a scenario as an obstacle of the planners.

use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Polygon, Window, outer_simplified};
use crate::obstacle::LandObstacle;
use crate::scenario::Scenario;

/// Most pieces of land that are planned against as they are in the map.
const MOST_PIECES: usize = 10_000;

/// Largest extent of a simplified piece, as a fraction of its distance from own ship's way. Each is
/// tried until the pieces are few enough.
const DETAIL: [f64; 4] = [0.05, 0.1, 0.2, 0.4];

/// Largest number of corners of a simplified piece.
const MOST_CORNERS: usize = 8;

/// The land that a plan is made against.
#[derive(Debug, Clone, Default)]
pub struct NearLand {
    /// Convex pieces.
    pub pieces: Vec<ConvexPolygon>,
    /// Number of the map's pieces that these pieces hold, where they are fewer and larger: an outer
    /// approximation. `None` where they are the map's own.
    pub simplified: Option<usize>,
}

impl NearLand {
    /// The simplified pieces as polygons; `None` where the map's own are used.
    pub(super) fn polygons(&self) -> Option<Vec<Polygon>> {
        self.simplified?;
        let rings = self.pieces.iter().map(|piece| piece.vertices().to_vec());
        let polygons = rings.map(|ring| Polygon::new(&[ring]));
        polygons.collect::<Result<_, _>>().ok()
    }
}

/// The convex pieces of land that own ship could reach before the horizon: at most some ten thousand.
///
/// Own ship is never farther than half its greatest sailing distance from the midpoint between its
/// start and its end. Where the map has more pieces there, those far from own ship's way are
/// replaced by the hulls of neighbours, which hold them and the water between them. O(n log n).
pub fn land_within_reach(scenario: &Scenario) -> NearLand {
    let Some(land) = &scenario.land else {
        return NearLand::default();
    };
    let own = &scenario.own_ship;
    let (start, end) = (own.pose.position, scenario.desired.end());
    let way = (own.max_speed() * scenario.horizon).max((end - start).norm());
    let window = Window::at((start + end) * 0.5).grown(0.5 * way + footprint(scenario));
    let pieces = land.map.pieces_within(&window);
    let all = pieces.len();
    if all <= MOST_PIECES {
        let pieces = pieces.into_iter().cloned().collect();
        return NearLand {
            pieces,
            simplified: None,
        };
    }
    let way = Way::of(scenario);
    let mut found = Vec::new();
    for detail in DETAIL {
        found.clear();
        simplify(&mut pieces.clone(), &way, detail, &mut found);
        if found.len() <= MOST_PIECES {
            break;
        }
    }
    NearLand {
        pieces: found,
        simplified: Some(all),
    }
}

/// Where own ship is to sail, and the room that it needs there.
struct Way {
    legs: Vec<[Vector; 2]>,
    /// Metres: no simplified piece comes nearer. Own ship fits between it and the way on any heading.
    room: f64,
}

impl Way {
    fn of(scenario: &Scenario) -> Self {
        let start = scenario.own_ship.pose.position;
        let main = [vec![start], scenario.desired.waypoints()].concat();
        let paths = scenario.alternatives.iter().chain([&main]);
        let legs = paths.flat_map(|path| path.windows(2).map(|ends| [ends[0], ends[1]]));
        Self {
            legs: legs.collect(),
            room: 2.0 * footprint(scenario),
        }
    }

    /// Lower bound of the distance of a box from the way, metres, less the room.
    fn beyond(&self, window: &Window) -> f64 {
        let (middle, half) = (window.center(), 0.5 * window.size().norm());
        let distance = |[a, b]: &[Vector; 2]| {
            let leg = b - a;
            // a leg of no length gives NaN, which is no share
            let share = (leg.dot(&(middle - a)) / leg.norm_squared()).clamp(0.0, 1.0);
            let share = if share.is_nan() { 0.0 } else { share };
            (a + leg * share - middle).norm()
        };
        let nearest = self.legs.iter().map(distance).fold(f64::INFINITY, f64::min);
        nearest - half - self.room
    }
}

/// Adds the hull of all pieces where it is small beside its distance from the way, or else those of
/// either half of them; a single piece that is not stays as it is.
fn simplify(pieces: &mut [&ConvexPolygon], way: &Way, detail: f64, found: &mut Vec<ConvexPolygon>) {
    let corners = || pieces.iter().flat_map(|piece| piece.vertices());
    let Some(window) = Window::around(corners()) else {
        return;
    };
    let size = window.size();
    if size.norm() <= detail * way.beyond(&window) {
        let corners: Vec<Vector> = corners().copied().collect();
        if let Ok(hull) = ConvexPolygon::hull(&corners)
            && hull.vertices().len() >= 3
        {
            let few = outer_simplified(&hull, MOST_CORNERS);
            let around = Window::around(few.vertices());
            let keeps_off = around.is_some_and(|window| way.beyond(&window) > 0.0);
            found.push(if keeps_off { few } else { hull });
            return;
        }
    }
    if let [piece] = pieces {
        found.push((*piece).clone());
        return;
    }
    let axis = usize::from(size.y > size.x);
    let place = |piece: &&ConvexPolygon| piece.centroid()[axis];
    let half = pieces.len() / 2;
    pieces.sort_by(|a, b| place(a).total_cmp(&place(b)));
    let (low, high) = pieces.split_at_mut(half);
    simplify(low, way, detail, found);
    simplify(high, way, detail, found);
}

/// Radius of water that own ship's centre needs on every heading, metres.
fn footprint(scenario: &Scenario) -> f64 {
    let margin = scenario.land.as_ref().map_or(0.0, |land| land.margin);
    scenario.own_ship.hull.half_diagonal() + margin
}

/// Pieces of land, as from [`land_within_reach`], grown by own ship's footprint.
pub fn land_obstacle(scenario: &Scenario, land: &[ConvexPolygon]) -> LandObstacle {
    LandObstacle::around(land, footprint(scenario))
}
