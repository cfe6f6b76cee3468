//! The REST API, a file for each subject: which points a query returns (amounts, regions, layers, single points,
//! paging), what is known of patterns without a table (patterns), how they are written (formats, and the same files
//! read by other software and by engines), what HTTP adds (caching, compression, methods, headers for browsers), and
//! which problem documents invalid addresses and bodies get.

mod amounts;
mod any_alpha;
mod browsers;
mod caching;
mod compression;
mod curl;
mod engine_formats;
mod except;
mod fields;
mod format_readers;
mod formats;
mod http;
mod invalid_addresses;
mod invalid_bodies;
mod kinds;
mod layers;
mod paging;
mod patterns;
mod periods;
mod profiles;
mod ranges;
mod regions;
mod single_points;
mod terrain;
mod varying_kinds;
mod worlds;
