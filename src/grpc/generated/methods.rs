// This file is @generated from proto/strew/v1.
/// The methods of the contract.
pub(super) static METHODS: &[Method] = &[
    Method {
        path: "/strew.v1.PointService/StreamPoints",
        shape: 0,
        read: |bytes| streamed(bytes, Points::stream_points),
    },
    Method {
        path: "/strew.v1.PointService/CountPoints",
        shape: 1,
        read: |bytes| once(bytes, Points::count_points),
    },
    Method {
        path: "/strew.v1.PointService/SplitPoints",
        shape: 2,
        read: |bytes| once(bytes, Points::split_points),
    },
    Method {
        path: "/strew.v1.PointService/GetPoint",
        shape: 3,
        read: |bytes| once(bytes, Points::get_point),
    },
    Method {
        path: "/strew.v1.PointService/FindNearest",
        shape: 4,
        read: |bytes| once(bytes, Points::find_nearest),
    },
    Method {
        path: "/strew.v1.PointService/ListProfiles",
        shape: 5,
        read: |bytes| once(bytes, Points::list_profiles),
    },
    Method {
        path: "/strew.v1.PointService/ListPeriods",
        shape: 6,
        read: |bytes| once(bytes, Points::list_periods),
    },
    Method {
        path: "/strew.v1.PointService/GetMask",
        shape: 7,
        read: |bytes| once(bytes, Points::get_mask),
    },
    Method {
        path: "/strew.v1.PointService/ListFields",
        shape: 8,
        read: |bytes| once(bytes, Points::list_fields),
    },
    Method {
        path: "/strew.v1.PointService/ListWorlds",
        shape: 9,
        read: |bytes| once(bytes, Points::list_worlds),
    },
];
