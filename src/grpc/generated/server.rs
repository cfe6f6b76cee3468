// This file is @generated from proto/strew/v1.
/// The paths of the methods.
pub static METHODS: [&str; 10] = [
    "/strew.v1.PointService/StreamPoints",
    "/strew.v1.PointService/CountPoints",
    "/strew.v1.PointService/SplitPoints",
    "/strew.v1.PointService/GetPoint",
    "/strew.v1.PointService/FindNearest",
    "/strew.v1.PointService/ListProfiles",
    "/strew.v1.PointService/ListPeriods",
    "/strew.v1.PointService/GetMask",
    "/strew.v1.PointService/ListFields",
    "/strew.v1.PointService/ListWorlds",
];
/// Generated server implementations.
pub mod point_service_server {
    #![allow(
        unused_variables,
        dead_code,
        missing_docs,
        clippy::wildcard_imports,
        clippy::let_unit_value,
    )]
    use tonic::codegen::*;
    /// Generated trait containing gRPC methods that should be implemented for use with PointServiceServer.
    #[async_trait]
    pub trait PointService: std::marker::Send + std::marker::Sync + 'static {
        /// Server streaming response type for the StreamPoints method.
        type StreamPointsStream: tonic::codegen::tokio_stream::Stream<
                Item = std::result::Result<
                    crate::grpc::proto::StreamPointsResponse,
                    tonic::Status,
                >,
            >
            + std::marker::Send
            + 'static;
        async fn stream_points(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::StreamPointsRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<Self::StreamPointsStream>,
            tonic::Status,
        >;
        async fn count_points(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::StreamPointsRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<crate::grpc::proto::CountPointsResponse>,
            tonic::Status,
        >;
        async fn split_points(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::SplitPointsRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<crate::grpc::proto::SplitPointsResponse>,
            tonic::Status,
        >;
        async fn get_point(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::GetPointRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<crate::grpc::proto::GetPointResponse>,
            tonic::Status,
        >;
        async fn find_nearest(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::FindNearestRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<crate::grpc::proto::FindNearestResponse>,
            tonic::Status,
        >;
        async fn list_profiles(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::ListProfilesRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<crate::grpc::proto::ListProfilesResponse>,
            tonic::Status,
        >;
        async fn list_periods(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::ListPeriodsRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<crate::grpc::proto::ListPeriodsResponse>,
            tonic::Status,
        >;
        async fn get_mask(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::GetMaskRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<crate::grpc::proto::GetMaskResponse>,
            tonic::Status,
        >;
        async fn list_fields(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::ListFieldsRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<crate::grpc::proto::ListFieldsResponse>,
            tonic::Status,
        >;
        async fn list_worlds(
            &self,
            request: tonic::Request<
                crate::grpc::codec::Raw<crate::grpc::proto::ListWorldsRequest>,
            >,
        ) -> std::result::Result<
            tonic::Response<crate::grpc::proto::ListWorldsResponse>,
            tonic::Status,
        >;
    }
    #[derive(Debug)]
    pub struct PointServiceServer<T> {
        inner: Arc<T>,
        accept_compression_encodings: EnabledCompressionEncodings,
        send_compression_encodings: EnabledCompressionEncodings,
        max_decoding_message_size: Option<usize>,
        max_encoding_message_size: Option<usize>,
    }
    impl<T> PointServiceServer<T> {
        pub fn new(inner: T) -> Self {
            Self::from_arc(Arc::new(inner))
        }
        pub fn from_arc(inner: Arc<T>) -> Self {
            Self {
                inner,
                accept_compression_encodings: Default::default(),
                send_compression_encodings: Default::default(),
                max_decoding_message_size: None,
                max_encoding_message_size: None,
            }
        }
        pub fn with_interceptor<F>(
            inner: T,
            interceptor: F,
        ) -> InterceptedService<Self, F>
        where
            F: tonic::service::Interceptor,
        {
            InterceptedService::new(Self::new(inner), interceptor)
        }
        /// Enable decompressing requests with the given encoding.
        #[must_use]
        pub fn accept_compressed(mut self, encoding: CompressionEncoding) -> Self {
            self.accept_compression_encodings.enable(encoding);
            self
        }
        /// Compress responses with the given encoding, if the client supports it.
        #[must_use]
        pub fn send_compressed(mut self, encoding: CompressionEncoding) -> Self {
            self.send_compression_encodings.enable(encoding);
            self
        }
        /// Limits the maximum size of a decoded message.
        ///
        /// Default: `4MB`
        #[must_use]
        pub fn max_decoding_message_size(mut self, limit: usize) -> Self {
            self.max_decoding_message_size = Some(limit);
            self
        }
        /// Limits the maximum size of an encoded message.
        ///
        /// Default: `usize::MAX`
        #[must_use]
        pub fn max_encoding_message_size(mut self, limit: usize) -> Self {
            self.max_encoding_message_size = Some(limit);
            self
        }
    }
    impl<T, B> tonic::codegen::Service<http::Request<B>> for PointServiceServer<T>
    where
        T: PointService,
        B: Body + std::marker::Send + 'static,
        B::Error: Into<StdError> + std::marker::Send + 'static,
    {
        type Response = http::Response<tonic::body::Body>;
        type Error = std::convert::Infallible;
        type Future = BoxFuture<Self::Response, Self::Error>;
        fn poll_ready(
            &mut self,
            _cx: &mut Context<'_>,
        ) -> Poll<std::result::Result<(), Self::Error>> {
            Poll::Ready(Ok(()))
        }
        fn call(&mut self, req: http::Request<B>) -> Self::Future {
            match req.uri().path() {
                "/strew.v1.PointService/StreamPoints" => {
                    #[allow(non_camel_case_types)]
                    struct StreamPointsSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::ServerStreamingService<
                        crate::grpc::codec::Raw<crate::grpc::proto::StreamPointsRequest>,
                    > for StreamPointsSvc<T> {
                        type Response = crate::grpc::proto::StreamPointsResponse;
                        type ResponseStream = T::StreamPointsStream;
                        type Future = BoxFuture<
                            tonic::Response<Self::ResponseStream>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<
                                    crate::grpc::proto::StreamPointsRequest,
                                >,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::stream_points(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = StreamPointsSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.server_streaming(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                "/strew.v1.PointService/CountPoints" => {
                    #[allow(non_camel_case_types)]
                    struct CountPointsSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::UnaryService<
                        crate::grpc::codec::Raw<crate::grpc::proto::StreamPointsRequest>,
                    > for CountPointsSvc<T> {
                        type Response = crate::grpc::proto::CountPointsResponse;
                        type Future = BoxFuture<
                            tonic::Response<Self::Response>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<
                                    crate::grpc::proto::StreamPointsRequest,
                                >,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::count_points(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = CountPointsSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.unary(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                "/strew.v1.PointService/SplitPoints" => {
                    #[allow(non_camel_case_types)]
                    struct SplitPointsSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::UnaryService<
                        crate::grpc::codec::Raw<crate::grpc::proto::SplitPointsRequest>,
                    > for SplitPointsSvc<T> {
                        type Response = crate::grpc::proto::SplitPointsResponse;
                        type Future = BoxFuture<
                            tonic::Response<Self::Response>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<
                                    crate::grpc::proto::SplitPointsRequest,
                                >,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::split_points(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = SplitPointsSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.unary(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                "/strew.v1.PointService/GetPoint" => {
                    #[allow(non_camel_case_types)]
                    struct GetPointSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::UnaryService<
                        crate::grpc::codec::Raw<crate::grpc::proto::GetPointRequest>,
                    > for GetPointSvc<T> {
                        type Response = crate::grpc::proto::GetPointResponse;
                        type Future = BoxFuture<
                            tonic::Response<Self::Response>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<crate::grpc::proto::GetPointRequest>,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::get_point(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = GetPointSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.unary(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                "/strew.v1.PointService/FindNearest" => {
                    #[allow(non_camel_case_types)]
                    struct FindNearestSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::UnaryService<
                        crate::grpc::codec::Raw<crate::grpc::proto::FindNearestRequest>,
                    > for FindNearestSvc<T> {
                        type Response = crate::grpc::proto::FindNearestResponse;
                        type Future = BoxFuture<
                            tonic::Response<Self::Response>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<
                                    crate::grpc::proto::FindNearestRequest,
                                >,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::find_nearest(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = FindNearestSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.unary(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                "/strew.v1.PointService/ListProfiles" => {
                    #[allow(non_camel_case_types)]
                    struct ListProfilesSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::UnaryService<
                        crate::grpc::codec::Raw<crate::grpc::proto::ListProfilesRequest>,
                    > for ListProfilesSvc<T> {
                        type Response = crate::grpc::proto::ListProfilesResponse;
                        type Future = BoxFuture<
                            tonic::Response<Self::Response>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<
                                    crate::grpc::proto::ListProfilesRequest,
                                >,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::list_profiles(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = ListProfilesSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.unary(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                "/strew.v1.PointService/ListPeriods" => {
                    #[allow(non_camel_case_types)]
                    struct ListPeriodsSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::UnaryService<
                        crate::grpc::codec::Raw<crate::grpc::proto::ListPeriodsRequest>,
                    > for ListPeriodsSvc<T> {
                        type Response = crate::grpc::proto::ListPeriodsResponse;
                        type Future = BoxFuture<
                            tonic::Response<Self::Response>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<
                                    crate::grpc::proto::ListPeriodsRequest,
                                >,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::list_periods(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = ListPeriodsSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.unary(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                "/strew.v1.PointService/GetMask" => {
                    #[allow(non_camel_case_types)]
                    struct GetMaskSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::UnaryService<
                        crate::grpc::codec::Raw<crate::grpc::proto::GetMaskRequest>,
                    > for GetMaskSvc<T> {
                        type Response = crate::grpc::proto::GetMaskResponse;
                        type Future = BoxFuture<
                            tonic::Response<Self::Response>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<crate::grpc::proto::GetMaskRequest>,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::get_mask(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = GetMaskSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.unary(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                "/strew.v1.PointService/ListFields" => {
                    #[allow(non_camel_case_types)]
                    struct ListFieldsSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::UnaryService<
                        crate::grpc::codec::Raw<crate::grpc::proto::ListFieldsRequest>,
                    > for ListFieldsSvc<T> {
                        type Response = crate::grpc::proto::ListFieldsResponse;
                        type Future = BoxFuture<
                            tonic::Response<Self::Response>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<
                                    crate::grpc::proto::ListFieldsRequest,
                                >,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::list_fields(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = ListFieldsSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.unary(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                "/strew.v1.PointService/ListWorlds" => {
                    #[allow(non_camel_case_types)]
                    struct ListWorldsSvc<T: PointService>(pub Arc<T>);
                    impl<
                        T: PointService,
                    > tonic::server::UnaryService<
                        crate::grpc::codec::Raw<crate::grpc::proto::ListWorldsRequest>,
                    > for ListWorldsSvc<T> {
                        type Response = crate::grpc::proto::ListWorldsResponse;
                        type Future = BoxFuture<
                            tonic::Response<Self::Response>,
                            tonic::Status,
                        >;
                        fn call(
                            &mut self,
                            request: tonic::Request<
                                crate::grpc::codec::Raw<
                                    crate::grpc::proto::ListWorldsRequest,
                                >,
                            >,
                        ) -> Self::Future {
                            let inner = Arc::clone(&self.0);
                            let fut = async move {
                                <T as PointService>::list_worlds(&inner, request).await
                            };
                            Box::pin(fut)
                        }
                    }
                    let accept_compression_encodings = self.accept_compression_encodings;
                    let send_compression_encodings = self.send_compression_encodings;
                    let max_decoding_message_size = self.max_decoding_message_size;
                    let max_encoding_message_size = self.max_encoding_message_size;
                    let inner = self.inner.clone();
                    let fut = async move {
                        let method = ListWorldsSvc(inner);
                        let codec = crate::grpc::codec::Codec::default();
                        let mut grpc = tonic::server::Grpc::new(codec)
                            .apply_compression_config(
                                accept_compression_encodings,
                                send_compression_encodings,
                            )
                            .apply_max_message_size_config(
                                max_decoding_message_size,
                                max_encoding_message_size,
                            );
                        let res = grpc.unary(method, req).await;
                        Ok(res)
                    };
                    Box::pin(fut)
                }
                _ => {
                    Box::pin(async move {
                        let mut response = http::Response::new(
                            tonic::body::Body::default(),
                        );
                        let headers = response.headers_mut();
                        headers
                            .insert(
                                tonic::Status::GRPC_STATUS,
                                (tonic::Code::Unimplemented as i32).into(),
                            );
                        headers
                            .insert(
                                http::header::CONTENT_TYPE,
                                tonic::metadata::GRPC_CONTENT_TYPE,
                            );
                        Ok(response)
                    })
                }
            }
        }
    }
    impl<T> Clone for PointServiceServer<T> {
        fn clone(&self) -> Self {
            let inner = self.inner.clone();
            Self {
                inner,
                accept_compression_encodings: self.accept_compression_encodings,
                send_compression_encodings: self.send_compression_encodings,
                max_decoding_message_size: self.max_decoding_message_size,
                max_encoding_message_size: self.max_encoding_message_size,
            }
        }
    }
    /// Generated gRPC service name
    pub const SERVICE_NAME: &str = "strew.v1.PointService";
    impl<T> tonic::server::NamedService for PointServiceServer<T> {
        const NAME: &'static str = SERVICE_NAME;
    }
}
