//! Random points over the whole range of parameters, log-uniform in every distance to a limit: no panic, no NaN, and the `error` that is
//! printed with a point is an honest bound. Continuous integration takes a sample; `POLHODE_RANDOM_POINTS=100000` sets how many.

mod rotation_group;
mod serret_andoyer;
mod spin;
