//! `searoom plan` as a user runs it.

mod out_of_reach;
mod outcomes;
mod previous;
mod routes;
mod rules;
