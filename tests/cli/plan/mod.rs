//! `searoom plan` as a user runs it.

mod outcomes;
mod previous;
mod routes;
mod rules;
