//! A* and Dijkstra over a graph that is given by its successors. Knows nothing of ships.
