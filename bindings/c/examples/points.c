/* Points of a box, of a chunk, near a place and in space: cc points.c $(pkg-config --cflags --libs strew) */

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include <strew.h>

/* Ends the program with the words of the library if a call fails. */
static void check(strew_code code) {
    if (code == STREW_OK) return;
    fprintf(stderr, "%s: %s\n", strew_error_kind(), strew_error_message());
    exit(1);
}

/* The points of a box, in a buffer of exactly the size that they need. */
static void box(const strew_library *library) {
    strew_plan *plan = NULL;
    check(strew_plan_query(library, 2, "bbox=0,0,10,10&spacing=1&seed=7", &plan));
    uint64_t count = 0;
    check(strew_plan_count(plan, &count));
    double *xy = malloc(2 * count * sizeof *xy);
    int64_t *ids = malloc(2 * count * sizeof *ids);
    if (!xy || !ids) abort();
    check(strew_plan_fill_coordinates(plan, xy, 2 * count));
    check(strew_plan_fill_ids(plan, ids, 2 * count));
    printf("%" PRIu64 " points in the box\n", count);
    for (int i = 0; i < 3; i++)
        printf("%" PRId64 ":%" PRId64 " at %.3f, %.3f\n", ids[2 * i], ids[2 * i + 1], xy[2 * i], xy[2 * i + 1]);
    free(ids);
    free(xy);
    strew_plan_free(plan);
}

/* What an engine loads for a square of its world: positions as float, an angle and a kind for each instance. */
static void chunk(const strew_library *library) {
    const char *forest = "{\"spacing\": 2, \"seed\": 5, \"attributes\": [\"angle\", \"variant\"],"
                         " \"variants\": {\"oak\": 3, \"birch\": 1}}";
    strew_plan *plan = NULL;
    const int64_t at[2] = {-3, 2};
    check(strew_plan_chunk(library, 2, forest, 64, at, &plan));
    uint64_t count = 0;
    check(strew_plan_count(plan, &count));
    double origin[2];
    float *xy = malloc(2 * count * sizeof *xy);
    double *angles = malloc(count * sizeof *angles);
    int32_t *variants = malloc(count * sizeof *variants);
    if (!xy || !angles || !variants) abort();
    check(strew_plan_fill_coordinates_f32(plan, xy, 2 * count, origin));
    check(strew_plan_fill_numbers(plan, "angle", angles, count));
    check(strew_plan_fill_codes(plan, "variant", variants, count));
    strew_bytes *columns = NULL;
    check(strew_plan_columns(plan, &columns));
    printf("%" PRIu64 " trees from %g, %g, with the columns %s\n", count, origin[0], origin[1],
           strew_bytes_data(columns));
    printf("the first at %.3f, %.3f, turned by %.3f, of kind %d\n", xy[0], xy[1], angles[0], (int)variants[0]);
    strew_bytes_free(columns);
    free(variants);
    free(angles);
    free(xy);
    strew_plan_free(plan);
}

/* Points in space: a ball, as x, y and z by turns. */
static void ball(const strew_library *library) {
    strew_plan *plan = NULL;
    check(strew_plan_query(library, 3, "ball=5,5,5,3&spacing=1&seed=7", &plan));
    uint64_t count = 0;
    check(strew_plan_count(plan, &count));
    double *xyz = malloc(3 * count * sizeof *xyz);
    if (!xyz) abort();
    check(strew_plan_fill_coordinates(plan, xyz, 3 * count));
    printf("%" PRIu64 " points in the ball, the first at %.3f, %.3f, %.3f\n", count, xyz[0], xyz[1], xyz[2]);
    free(xyz);
    strew_plan_free(plan);
}

int main(void) {
    strew_library *library = NULL;
    check(strew_library_open(NULL, &library));
    box(library);
    chunk(library);
    ball(library);
    strew_point nearest[3];
    size_t found = 0;
    check(strew_nearest(library, 2, "at=5,5&k=3&spacing=1&seed=7", nearest, 3, &found, NULL));
    printf("%zu points near 5, 5; the nearest is %.3f away\n", found, nearest[0].distance);
    strew_plan *plan = NULL;
    if (strew_plan_query(library, 2, "bbox=0,0,10,10&spacing=-1", &plan) == STREW_INVALID_QUERY)
        printf("refused: %s\n", strew_error_message());
    strew_library_free(library);
    return 0;
}
