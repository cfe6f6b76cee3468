# A cache of chunks and documents before one or several daemons, for Varnish 7. Those whose address holds a digest
# (`table=…`, `world_digest=…`) never change and are kept for a year; others for as long as the daemon says. Nothing
# ever needs to be purged: another table or world has another digest, and so another address. The points of regions
# (`/v1/points`) and answers of more than a million points are not kept.
#
#     varnishd -a :80 -f strew.vcl -s malloc,2g -s Transient=malloc,256m -p http_gzip_support=off \
#         -p http_req_size=128k -p http_req_hdr_len=64k -p workspace_client=320k -p workspace_backend=320k
#
# Without http_gzip_support=off Varnish requests gzip for every client, also of packed coordinates, which hardly shrink.
# The other parameters let addresses of up to 64 KiB through, as the daemon does; by default Varnish ends at 32.
# Transient holds what is neither kept nor piped while it is sent: short documents. gRPC does not pass: Varnish speaks
# HTTP/1.1 to daemons. For several daemons put the address of their balancer here, or a backend for each and a director
# (vmod_directors).

vcl 4.1;
import std;

backend strew {
    .host = "strew";
    .port = "8080";
    .probe = {
        .url = "/readyz";
        .interval = 1s;
        .window = 1;
        .threshold = 1;
        .initial = 1;
    }
}

sub vcl_recv {
    # Internal.
    if (req.url ~ "^/metrics") {
        return (synth(404));
    }
    # Varnish reads an answer ahead into memory as fast as it comes, however slow its client is. So what can have any
    # number of points and is not kept goes straight through, on a connection of its own: regions, posted arrangements,
    # chunks for clients with a key, and what `vcl_deliver` sends here again.
    if (req.restarts == 0) {
        unset req.http.Strew-Large;
    }
    if (req.http.Strew-Large || req.url ~ "^/v1/points[?:]") {
        return (pipe);
    }
    if (req.method == "POST" && req.url ~ "^/v1/pattern/arrangements") {
        return (pipe);
    }
    if ((req.http.Authorization || req.http.X-API-Key) && req.url ~ "^/v1/[^?]*(chunks/|arrangements)") {
        return (pipe);
    }
    # The daemon reads none, and Varnish keeps nothing for clients that send some.
    unset req.http.Cookie;
    # Clients accept codings in many words; the daemon has three answers, which differ by `Vary`.
    if (req.http.Accept-Encoding ~ "zstd") {
        set req.http.Accept-Encoding = "zstd";
    } else if (req.http.Accept-Encoding ~ "gzip") {
        set req.http.Accept-Encoding = "gzip";
    } else {
        unset req.http.Accept-Encoding;
    }
    if (std.healthy(req.backend_hint)) {
        set req.grace = 0s;
    }
    # Answers with a key are `private`.
    if (req.http.Authorization || req.http.X-API-Key) {
        return (pass);
    }
    # Otherwise Varnish would fetch all the points to answer with their number.
    if (req.method == "HEAD") {
        return (pass);
    }
}

sub vcl_backend_response {
    # An answer of more than a million points would push many chunks out. Only that it is large is kept, and it
    # is requested again. With `rate.points_per_second` the first request therefore costs twice.
    if (bereq.method == "GET" && std.integer(beresp.http.Strew-Count, 0) > 1000000) {
        return (error(503, "Large"));
    }
    # An old answer is better than none, while there is no daemon. What is too old is compared by its tag for a day: an
    # answer of 304 makes no points.
    set beresp.grace = 1h;
    set beresp.keep = 1d;
}

sub vcl_backend_error {
    if (beresp.reason == "Large") {
        set beresp.http.Strew-Large = "1";
        set beresp.ttl = 1d;
        return (deliver);
    }
}

sub vcl_deliver {
    if (resp.http.Strew-Large && req.restarts == 0) {
        set req.http.Strew-Large = "1";
        return (restart);
    }
    if (obj.hits > 0) {
        set resp.http.X-Cache-Status = "HIT";
    } else {
        set resp.http.X-Cache-Status = "MISS";
    }
}
