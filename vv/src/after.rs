//! What comes after a run: its folder read again, the fragments of a state, two runs side by side.

pub mod compare;
pub mod fragments;
pub mod ledger;
