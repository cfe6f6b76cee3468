# A cache of answers before one or several daemons, for Varnish 7. Answers whose address holds a digest (`table=…`,
# `world_digest=…`) never change and are kept for a year; others for as long as the daemon says. Nothing ever needs to be
# purged: another table or world has another digest, and so another address.
#
#     varnishd -a :80 -f strew.vcl -s malloc,2g -s Transient=malloc,256m -p http_gzip_support=off
#
# Without http_gzip_support=off Varnish requests gzip for every client, also of packed coordinates, which hardly shrink.
# Transient holds what is not kept while it is sent. gRPC does not pass: Varnish speaks HTTP/1.1 to daemons. For several
# daemons put the address of their balancer here, or a backend for each and a director (vmod_directors).

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
    # A region can have any number of points, and Varnish reads an answer as fast as it comes, however slow its client
    # is. So these go straight through; chunks are what is kept.
    if (req.url ~ "^/v1/points[?:]") {
        return (pipe);
    }
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
    # An answer of more than a million points would push many chunks out.
    if (std.integer(beresp.http.Strew-Count, 0) > 1000000) {
        set beresp.uncacheable = true;
    }
    # An old answer is better than none, while there is no daemon. What is too old is compared by its tag for a day: an
    # answer of 304 makes no points.
    set beresp.grace = 1h;
    set beresp.keep = 1d;
}

sub vcl_deliver {
    if (obj.hits > 0) {
        set resp.http.X-Cache-Status = "HIT";
    } else {
        set resp.http.X-Cache-Status = "MISS";
    }
}
