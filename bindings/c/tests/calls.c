/* What callers do wrong has a code and words, and harms nothing: run under AddressSanitizer by .ci/c. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <pthread.h>

#include <strew.h>

#define EXPECT(condition)                                                        \
    do {                                                                         \
        if (!(condition)) {                                                      \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);      \
            fprintf(stderr, "the last error: %s\n", strew_error_message());      \
            exit(1);                                                             \
        }                                                                        \
    } while (0)

static strew_library *library;

static strew_plan *planned(const char *query) {
    strew_plan *plan = NULL;
    EXPECT(strew_plan_query(library, 2, query, &plan) == STREW_OK);
    return plan;
}

/* Null for every pointer, text that is not UTF-8, buffers that are too small. */
static void arguments(void) {
    strew_plan *plan = NULL;
    const int64_t origin[2] = {1, 1};
    EXPECT(strew_library_open(NULL, NULL) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_plan_query(NULL, 2, "", &plan) == STREW_INVALID_ARGUMENT);
    EXPECT(strcmp(strew_error_field(), "library") == 0);
    EXPECT(strew_plan_query(library, 2, NULL, &plan) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_plan_query(library, 2, "spacing=1", NULL) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_plan_query(library, 2, "\xff", &plan) == STREW_INVALID_ARGUMENT);
    EXPECT(strcmp(strew_error_message(), "`query`: not UTF-8; allowed: text in UTF-8") == 0);
    EXPECT(strew_plan_chunk(library, 2, "spacing=1", 0.0 / 0.0, origin, &plan) == STREW_INVALID_QUERY);
    EXPECT(strew_plan_chunk(library, 2, "spacing=1", -1, origin, &plan) == STREW_INVALID_QUERY);
    EXPECT(strew_plan_chunk(library, 2, "spacing=1", 1, NULL, &plan) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_plan_query(library, 4, "spacing=1", &plan) == STREW_INVALID_ARGUMENT);
    EXPECT(strcmp(strew_error_field(), "axes") == 0);
    EXPECT(plan == NULL && strew_plan_axes(NULL) == 0);
    EXPECT(strew_plan_count(NULL, NULL) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_nearest(library, 2, "at=0,0&spacing=1", NULL, 1, NULL, NULL) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_nearest(library, 2, "at=0,0&spacing=1", NULL, 0, NULL, NULL) == STREW_OK);
    EXPECT(strew_point_by_id(library, 2, "spacing=1", origin, NULL, NULL) == STREW_INVALID_ARGUMENT);
    strew_point point;
    EXPECT(strew_point_by_id(library, 2, "spacing=1", origin, &point, NULL) == STREW_NO_SUCH_POINT);
    EXPECT(strcmp(strew_error_kind(), "no-such-point") == 0);
    strew_library *other = NULL;
    EXPECT(strew_library_open("no/such/folder", &other) == STREW_TABLE_UNREADABLE);
    EXPECT(other == NULL && strstr(strew_error_message(), "no/such/folder"));
    EXPECT(strew_bytes_data(NULL) == NULL && strew_bytes_length(NULL) == 0);
    strew_library_free(NULL);
    strew_plan_free(NULL);
    strew_bytes_free(NULL);
}

/* Other tables than the embedded ones are files. */
static void tables(void) {
    strew_plan *plan = NULL;
    const char *green = "bbox=0,0,10,10&spacing=1&profile=green&map=s";
    EXPECT(strew_plan_query(library, 2, green, &plan) == STREW_INVALID_QUERY);
    EXPECT(strcmp(strew_error_field(), "profile") == 0);
    EXPECT(strstr(strew_error_message(), "open a folder that has its file") && !strstr(strew_error_message(), "forge"));
    strew_library *whole = NULL;
    EXPECT(strew_library_open(getenv("TABLES"), &whole) == STREW_OK);
    EXPECT(strew_plan_query(whole, 2, green, &plan) == STREW_OK);
    strew_plan_free(plan);
    EXPECT(strew_plan_query(whole, 2, "bbox=0,0,9,9&spacing=1&variants=a:1,b:3&spread=joint", &plan) == STREW_OK);
    strew_plan_free(plan);
    strew_library_free(whole);
    EXPECT(strcmp(strew_version(), STREW_VERSION_STRING) == 0);
}

/* The buffers, to their last place and not beyond. */
static void buffers(void) {
    strew_plan *plan = planned("bbox=0,0,10,10&spacing=1&seed=7&attributes=angle,variant&variants=oak:3,birch:1");
    uint64_t count = 0;
    EXPECT(strew_plan_count(plan, &count) == STREW_OK && count == 100);
    double *xy = malloc(2 * count * sizeof *xy), *angles = malloc(count * sizeof *angles);
    float *near = malloc(2 * count * sizeof *near);
    int64_t *ids = malloc(2 * count * sizeof *ids);
    int32_t *codes = malloc(count * sizeof *codes);
    EXPECT(xy && angles && near && ids && codes);
    EXPECT(strew_plan_fill_coordinates(plan, xy, 2 * count - 1) == STREW_BUFFER_TOO_SMALL);
    EXPECT(strcmp(strew_error_message(),
                  "`capacity` = `199`: is less than the 100 points need; allowed: 200 or more") == 0);
    EXPECT(strew_plan_fill_coordinates(plan, NULL, 2 * count) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_plan_fill_coordinates(plan, xy, 2 * count) == STREW_OK);
    double origin[2] = {1, 1};
    EXPECT(strew_plan_fill_coordinates_f32(plan, near, 2 * count, origin) == STREW_OK && origin[0] == 0);
    EXPECT(strew_plan_fill_coordinates_f32(plan, near, 2 * count, NULL) == STREW_OK);
    EXPECT(strew_plan_fill_ids(plan, ids, 2 * count) == STREW_OK);
    EXPECT(strew_plan_fill_ids(plan, ids, 0) == STREW_BUFFER_TOO_SMALL);
    EXPECT(strew_plan_fill_numbers(plan, "angle", angles, count) == STREW_OK);
    EXPECT(strew_plan_fill_codes(plan, "variant", codes, count) == STREW_OK);
    EXPECT(strew_plan_fill_codes(plan, "angle", codes, count) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_plan_fill_numbers(plan, "variant", angles, count) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_plan_fill_numbers(plan, "size", angles, count) == STREW_INVALID_ARGUMENT);
    EXPECT(strcmp(strew_error_message(), "`column`: no column `size`; allowed: angle, variant") == 0);
    for (uint64_t i = 0; i < count; i++) {
        strew_point found;
        EXPECT(strew_point_by_id(library, 2, "spacing=1&seed=7", ids + 2 * i, &found, NULL) == STREW_OK);
        EXPECT(found.x == xy[2 * i] && found.y == xy[2 * i + 1]);
        EXPECT(near[2 * i] >= 0 && near[2 * i] < 10 && codes[i] >= 0 && codes[i] < 2);
    }
    strew_bytes *bytes = NULL;
    EXPECT(strew_plan_document(plan, "format=csv&decimals=2", &bytes) == STREW_OK);
    EXPECT(strncmp(strew_bytes_data(bytes), "id,x,y,angle,variant\n", 21) == 0);
    EXPECT(strlen(strew_bytes_data(bytes)) == strew_bytes_length(bytes));
    strew_bytes_free(bytes);
    EXPECT(strew_plan_document(plan, "format=cvs", &bytes) == STREW_INVALID_QUERY);
    EXPECT(strew_plan_split(plan, 4, &bytes) == STREW_OK && strstr(strew_bytes_data(bytes), "\"limit\":25"));
    strew_bytes_free(bytes);
    EXPECT(strew_plan_split(plan, 0, &bytes) == STREW_INVALID_QUERY);
    strew_plan_free(plan);
    free(codes);
    free(ids);
    free(near);
    free(angles);
    free(xy);
    plan = planned("bbox=0.1,0.1,0.2,0.2&spacing=50");
    EXPECT(strew_plan_fill_coordinates(plan, NULL, 0) == STREW_OK);
    strew_plan_free(plan);
    plan = planned("bbox=-5e5,-5e5,5e5,5e5&spacing=0.001");
    EXPECT(strew_plan_count(plan, &count) == STREW_OK && count > 999999999000000000u);
    EXPECT(strew_plan_fill_coordinates(plan, NULL, 0) == STREW_TOO_MANY_POINTS);
    strew_plan_free(plan);
}

/* Points in space, by the same calls. */
static void space(void) {
    strew_plan *plan = NULL;
    const int64_t cube[3] = {-3, 2, 1}, nowhere[3] = {1, 0, 0};
    EXPECT(strew_plan_query(library, 3, NULL, &plan) == STREW_INVALID_ARGUMENT);
    EXPECT(strew_plan_query(library, 3, "bbox=0,0,1,1&spacing=1", &plan) == STREW_INVALID_QUERY);
    EXPECT(strew_plan_chunk(library, 3, "spacing=1", -1, cube, &plan) == STREW_INVALID_QUERY);
    EXPECT(strew_plan_chunk(library, 3, "spacing=1&attributes=rotation", 4, cube, &plan) == STREW_OK);
    uint64_t count = 0;
    EXPECT(strew_plan_count(plan, &count) == STREW_OK && count > 40 && strew_plan_axes(plan) == 3);
    double *xyz = malloc(3 * count * sizeof *xyz), *turns = malloc(count * sizeof *turns), origin[3] = {1, 1, 1};
    float *near = malloc(3 * count * sizeof *near);
    int64_t *ids = malloc(3 * count * sizeof *ids);
    EXPECT(xyz && turns && near && ids);
    /* Buffers for pairs are too small: nothing is written. */
    for (uint64_t i = 0; i < 3 * count; i++) xyz[i] = near[i] = (float)(ids[i] = -99);
    const strew_code doubles = strew_plan_fill_coordinates(plan, xyz, 2 * count);
    const strew_code floats = strew_plan_fill_coordinates_f32(plan, near, 3 * count - 1, NULL);
    const strew_code integers = strew_plan_fill_ids(plan, ids, 2 * count);
    for (uint64_t i = 0; i < 3 * count; i++) EXPECT(xyz[i] == -99 && near[i] == -99 && ids[i] == -99);
    EXPECT(doubles == STREW_BUFFER_TOO_SMALL && floats == doubles && integers == doubles);
    EXPECT(strew_plan_fill_coordinates(plan, xyz, 3 * count) == STREW_OK);
    EXPECT(strew_plan_fill_coordinates_f32(plan, near, 3 * count, origin) == STREW_OK && origin[0] == -12);
    EXPECT(strew_plan_origin(plan, origin) == STREW_OK && origin[1] == 8 && origin[2] == 4);
    EXPECT(strew_plan_fill_ids(plan, ids, 3 * count) == STREW_OK);
    EXPECT(strew_plan_fill_numbers(plan, "qw", turns, count) == STREW_OK);
    for (uint64_t i = 0; i < count; i++) {
        strew_point found;
        int64_t *id = ids + 3 * i;
        EXPECT(strew_point_by_id(library, 3, "spacing=1", id, &found, NULL) == STREW_OK);
        EXPECT(found.id[2] == id[2] && found.z >= 4 && found.z < 8 && near[3 * i + 2] >= 0 && near[3 * i + 2] < 4);
    }
    strew_point nearest[2];
    size_t some = 0;
    EXPECT(strew_nearest(library, 3, "at=1,2,3&k=2&spacing=1", nearest, 2, &some, NULL) == STREW_OK && some == 2);
    EXPECT(nearest[0].distance <= nearest[1].distance);
    EXPECT(strew_nearest(library, 3, "at=1,2&spacing=1", nearest, 2, &some, NULL) == STREW_INVALID_QUERY);
    EXPECT(strew_point_by_id(library, 3, "spacing=1", nowhere, nearest, NULL) == STREW_NO_SUCH_POINT);
    strew_plan_free(plan);
    free(ids);
    free(near);
    free(turns);
    free(xyz);
}

/* Words are those of the thread that made the mistake. */
static void *mistaken(void *query) {
    strew_plan *plan = NULL;
    EXPECT(strcmp(strew_error_message(), "") == 0);
    EXPECT(strew_plan_query(library, 2, query, &plan) == STREW_INVALID_QUERY);
    EXPECT(strstr(strew_error_message(), query));
    EXPECT(strstr(strew_error_document(), "\"errors\":[{\"field\":"));
    return NULL;
}

int main(void) {
    EXPECT(strlen(strew_version()) > 0);
    EXPECT(strew_library_open(NULL, &library) == STREW_OK);
    arguments();
    tables();
    buffers();
    space();
    pthread_t threads[2];
    char queries[2][16] = {"one", "two"};
    for (int i = 0; i < 2; i++) EXPECT(pthread_create(&threads[i], NULL, mistaken, queries[i]) == 0);
    for (int i = 0; i < 2; i++) EXPECT(pthread_join(threads[i], NULL) == 0);
    /* A plan outlives its library. */
    strew_plan *plan = planned("circle=0,0,2&spacing=1");
    strew_library_free(library);
    uint64_t count = 0;
    EXPECT(strew_plan_count(plan, &count) == STREW_OK && count > 8);
    double xy[2 * 32];
    EXPECT(strew_plan_fill_coordinates(plan, xy, 2 * 32) == STREW_OK);
    strew_plan_free(plan);
    puts("all calls are as they should be");
    return 0;
}
