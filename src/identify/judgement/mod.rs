//! What to make of a fit: whether the model describes the data, whether the methods agree, which records
//! pull, and which mistakes of the laboratory the data give away.

pub mod agreement;
pub mod beyond;
pub mod contact_law;
pub mod interchange;
pub mod pull;
pub mod suspicion;
pub mod verdict;
