//! Every encoding carries the library's points, in the library's order.

use strew::grpc::proto::{
    Encoding, PointSet, StreamPointsRequest, point_service_client::PointServiceClient,
    point_set::Amount, region::Shape,
};
use strew_core::Point;

use crate::support::{
    daemon::{Daemon, PROFILE},
    grpc::{boxed, collect},
    library::{assert_same, plan, points},
};

fn request(encoding: Encoding) -> StreamPointsRequest {
    StreamPointsRequest {
        region: boxed([-3.5, 1.0, 40.0, 33.25]),
        set: Some(PointSet {
            amount: Some(Amount::Density(7.0)),
            profile: Some(PROFILE.into()),
            seed: Some(5),
            ..PointSet::default()
        }),
        encoding: encoding.into(),
        ..StreamPointsRequest::default()
    }
}

#[tokio::test]
async fn the_default_encoding_has_fields_and_ids() {
    let daemon = Daemon::start(&["limits.block_bytes=4096"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let plan = plan();
    for encoding in [Encoding::Unspecified, Encoding::Points] {
        let whole = collect(&mut client, request(encoding)).await;
        let (header, blocks) = (whole.header, whole.blocks);
        assert_eq!(header.count, plan.count() as u64);
        assert_eq!(whole.summary.count, header.count);
        assert_eq!(whole.summary.next_cursor, "");
        assert_eq!(header.algorithm, strew_core::ALGORITHM_VERSION);
        assert_eq!((header.origin, header.columns.len()), (None, 0));
        let query = header.query.expect("set");
        assert_eq!(query.region, request(encoding).region);
        let bbox = query.bbox.map(Shape::Bbox);
        assert_eq!(query.region.as_ref().map(|r| r.shape.clone()), Some(bbox));
        assert_eq!(query.encoding(), Encoding::Points);
        let [resolved] = query.sets.as_slice() else {
            panic!("there is one set of points");
        };
        assert_eq!(resolved.density, 7.0);
        let placement = plan.placement();
        let set = PointSet {
            amount: Some(Amount::Spacing(placement.spacing.get())),
            profile: Some(PROFILE.into()),
            alpha: Some("(5-sqrt(3))/2".into()),
            map: Some(plan.table().map().size().to_string()),
            table: Some(plan.table().digest().to_string()),
            seed: Some(5),
            warp: Some(placement.warp.strength()),
            ..PointSet::default()
        };
        assert_eq!(resolved.set, Some(set));
        assert!(blocks.len() > 10, "blocks are small");
        let got: Vec<Point> = blocks
            .iter()
            .flat_map(|block| {
                assert_eq!(block.x.len(), block.y.len());
                assert_eq!(block.x.len(), block.id.len());
                block.x.iter().zip(&block.y).zip(&block.id)
            })
            .map(|((&x, &y), id)| Point {
                id: id.parse().expect("an id"),
                x,
                y,
            })
            .collect();
        assert_same(&got, &points(&plan));
    }
}
