//! Search over the whole plane: a cost-to-go grid, and a hybrid A* that it guides.

pub(crate) mod cost_to_go;
pub(crate) mod hybrid_a_star;
