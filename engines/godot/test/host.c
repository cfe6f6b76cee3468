/* Plays the part of Godot for the extension: the functions that it uses, over plain C memory, checked with
 * AddressSanitizer. `host LIBRARY` loads the extension, calls its methods and ends it. It stands in for an engine, which
 * is needed to know that Godot itself agrees. */

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gdextension_interface.h>

#define EXPECT(condition)                                                   \
    do {                                                                    \
        if (!(condition)) {                                                 \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
            exit(1);                                                        \
        }                                                                   \
    } while (0)

/* Strings and names hold a pointer to a copy; arrays one to their floats. All things made are counted. */
typedef struct {
    float *data;
    int64_t size;
} floats;
typedef struct {
    GDExtensionVariantType type;
    union {
        char *text;
        int64_t whole;
        double number;
        floats array;
    } of;
} variant;

static int alive;
static const GDExtensionClassCreationInfo2 *class_info;
static GDExtensionClassCreationInfo2 kept;
static GDExtensionClassMethodInfo methods[8];
static char names[8][32];
static int method_count;
static void *instance;

static char *copied(const char *text) {
    alive++;
    return strcpy(malloc(strlen(text) + 1), text);
}

static void new_name(void *place, const char *text, GDExtensionBool is_static) {
    EXPECT(!is_static);
    *(char **)place = copied(text);
}
static void new_string(void *place, const char *text) { *(char **)place = copied(text); }
static void free_text(void *place) {
    free(*(char **)place);
    alive--;
}
static GDExtensionInt to_utf8(const void *text, char *out, GDExtensionInt room) {
    const char *from = *(char *const *)text;
    GDExtensionInt length = (GDExtensionInt)strlen(from);
    if (out) memcpy(out, from, (size_t)(length < room ? length : room));
    return length;
}
static void new_floats(void *place, const GDExtensionConstTypePtr *arguments) {
    EXPECT(arguments == NULL);
    *(floats *)place = (floats){NULL, 0};
    alive++;
}
static void free_floats(void *place) {
    free(((floats *)place)->data);
    alive--;
}
static void resize(void *place, const GDExtensionConstTypePtr *arguments, void *result, int count) {
    floats *array = place;
    EXPECT(count == 1);
    array->size = *(const int64_t *)arguments[0];
    array->data = realloc(array->data, (size_t)array->size * sizeof(float) + 1);
    *(int64_t *)result = 0;
}
static float *float_at(void *place, GDExtensionInt index) { return ((floats *)place)->data + index; }

static void variant_of_floats(void *out, void *from) {
    const floats *array = from;
    variant *made = out;
    size_t bytes = (size_t)array->size * sizeof(float);
    made->type = GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY;
    made->of.array = (floats){memcpy(malloc(bytes + 1), array->data ? array->data : (void *)"", bytes), array->size};
}
static void variant_of_string(void *out, void *from) {
    variant *made = out;
    made->type = GDEXTENSION_VARIANT_TYPE_STRING;
    made->of.text = strdup(*(char **)from);
}
static void to_string(void *out, void *from) { *(char **)out = copied(((variant *)from)->of.text); }
static void to_float(void *out, void *from) { *(double *)out = ((variant *)from)->of.number; }
static void to_int(void *out, void *from) { *(int64_t *)out = ((variant *)from)->of.whole; }
static GDExtensionVariantType type_of(const void *value) { return ((const variant *)value)->type; }

static void register_class(void *own, const void *name, const void *parent, const GDExtensionClassCreationInfo2 *info) {
    EXPECT(own == (void *)&alive && !strcmp(*(char *const *)name, "StrewNative"));
    EXPECT(!strcmp(*(char *const *)parent, "RefCounted"));
    kept = *info;
    class_info = &kept;
}
static void register_method(void *own, const void *name, const GDExtensionClassMethodInfo *info) {
    EXPECT(own == (void *)&alive && !strcmp(*(char *const *)name, "StrewNative"));
    strcpy(names[method_count], *(char **)info->name);
    for (uint32_t i = 0; i < info->argument_count; i++) EXPECT(**(char **)info->arguments_info[i].name);
    methods[method_count++] = *info;
}
static void unregister_class(void *own, const void *name) {
    EXPECT(own == (void *)&alive && !strcmp(*(char *const *)name, "StrewNative"));
    class_info = NULL;
}
static void *construct_object(const void *name) {
    EXPECT(!strcmp(*(char *const *)name, "RefCounted"));
    return &method_count;
}
static void set_instance(void *object, const void *name, void *made) {
    EXPECT(object == &method_count && !strcmp(*(char *const *)name, "StrewNative"));
    instance = made;
}

static GDExtensionPtrBuiltInMethod builtin(GDExtensionVariantType type, const void *name, GDExtensionInt hash) {
    EXPECT(type == GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY && !strcmp(*(char *const *)name, "resize"));
    return hash == 848867239 ? resize : NULL;
}
static GDExtensionPtrConstructor constructor(GDExtensionVariantType type, int32_t index) {
    EXPECT(type == GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY && index == 0);
    return new_floats;
}
static GDExtensionPtrDestructor destructor(GDExtensionVariantType type) {
    return type == GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY ? free_floats : free_text;
}
static GDExtensionVariantFromTypeConstructorFunc from_type(GDExtensionVariantType type) {
    return type == GDEXTENSION_VARIANT_TYPE_STRING ? variant_of_string : variant_of_floats;
}
static GDExtensionTypeFromVariantConstructorFunc to_type(GDExtensionVariantType type) {
    if (type == GDEXTENSION_VARIANT_TYPE_STRING) return to_string;
    return type == GDEXTENSION_VARIANT_TYPE_FLOAT ? to_float : to_int;
}

static GDExtensionInterfaceFunctionPtr find(const char *name) {
    static const struct {
        const char *name;
        void (*function)(void);
    } all[] = {
#define KNOWS(name, function) {name, (void (*)(void))function}
        KNOWS("classdb_register_extension_class2", register_class),
        KNOWS("classdb_register_extension_class_method", register_method),
        KNOWS("classdb_unregister_extension_class", unregister_class),
        KNOWS("classdb_construct_object", construct_object),
        KNOWS("object_set_instance", set_instance),
        KNOWS("string_name_new_with_latin1_chars", new_name),
        KNOWS("string_new_with_utf8_chars", new_string),
        KNOWS("string_to_utf8_chars", to_utf8),
        KNOWS("packed_float32_array_operator_index", float_at),
        KNOWS("variant_get_type", type_of),
        KNOWS("variant_get_ptr_builtin_method", builtin),
        KNOWS("variant_get_ptr_constructor", constructor),
        KNOWS("variant_get_ptr_destructor", destructor),
        KNOWS("get_variant_from_type_constructor", from_type),
        KNOWS("get_variant_to_type_constructor", to_type),
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (!strcmp(all[i].name, name)) return (GDExtensionInterfaceFunctionPtr)all[i].function;
    fprintf(stderr, "the extension uses %s, which the host lacks\n", name);
    exit(1);
}

/* Calls a method with Variants. */
static variant called(const char *name, const variant *arguments, int count, GDExtensionCallErrorType expected) {
    int i = 0;
    while (strcmp(names[i], name)) EXPECT(++i < method_count);
    const void *given[4];
    for (int j = 0; j < count; j++) given[j] = &arguments[j];
    variant result = {0};
    GDExtensionCallError error = {0};
    methods[i].call_func(methods[i].method_userdata, instance, (void *)given, count, &result, &error);
    EXPECT(error.error == expected);
    return result;
}

static variant text(const char *of) {
    return (variant){GDEXTENSION_VARIANT_TYPE_STRING, {.text = (char *)of}};
}
static variant whole(int64_t of) { return (variant){GDEXTENSION_VARIANT_TYPE_INT, {.whole = of}}; }
static variant number(double of) { return (variant){GDEXTENSION_VARIANT_TYPE_FLOAT, {.number = of}}; }

static void expect_message(const char *part) {
    variant message = called("message", NULL, 0, GDEXTENSION_CALL_OK);
    EXPECT(part ? strstr(message.of.text, part) != NULL : !*message.of.text);
    free(message.of.text);
}

int main(int count, char **words) {
    EXPECT(count == 2);
    void *loaded = dlopen(words[1], RTLD_NOW);
    if (!loaded) fprintf(stderr, "%s\n", dlerror());
    EXPECT(loaded);
    GDExtensionInitializationFunction start;
    *(void **)&start = dlsym(loaded, "strew_native_init");
    EXPECT(start && !dlsym(loaded, "strew_plan_query"));
    GDExtensionInitialization levels = {0};
    EXPECT(start(find, (GDExtensionClassLibraryPtr)&alive, &levels));
    for (int level = 0; level < GDEXTENSION_MAX_INITIALIZATION_LEVEL; level++)
        levels.initialize(levels.userdata, (GDExtensionInitializationLevel)level);
    EXPECT(class_info && method_count == 3);
    EXPECT(class_info->create_instance_func(class_info->class_userdata) == &method_count && instance);

    const char *query = "spacing=2&seed=7&attributes=angle,scale";
    variant chunk[] = {text(query), whole(64), whole(-3), whole(2)};
    variant made = called("chunk", chunk, 4, GDEXTENSION_CALL_OK);
    EXPECT(made.of.array.size > 900 * 16 && made.of.array.size % 16 == 0);
    chunk[1] = number(64);
    variant again = called("chunk", chunk, 4, GDEXTENSION_CALL_OK);
    EXPECT(again.of.array.size == made.of.array.size);
    EXPECT(!memcmp(again.of.array.data, made.of.array.data, (size_t)made.of.array.size * sizeof(float)));
    expect_message(NULL);
    for (int64_t at = 0; at < made.of.array.size; at += 16)
        EXPECT(made.of.array.data[at + 3] >= 0 && made.of.array.data[at + 3] < 64 && made.of.array.data[at + 11] <= 0);
    printf("%d points in the chunk\n", (int)(made.of.array.size / 16));
    free(again.of.array.data);
    free(made.of.array.data);

    variant box = text("bbox=0,0,10,10&spacing=-1");
    made = called("region", &box, 1, GDEXTENSION_CALL_OK);
    EXPECT(made.of.array.size == 0);
    expect_message("`spacing` = `-1`");
    free(made.of.array.data);
    called("region", &box, 0, GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS);
    called("chunk", (variant[]){text(query), text("64"), whole(0), whole(0)}, 4, GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT);

    class_info->free_instance_func(class_info->class_userdata, instance);
    for (int level = GDEXTENSION_MAX_INITIALIZATION_LEVEL; level-- > 0;)
        levels.deinitialize(levels.userdata, (GDExtensionInitializationLevel)level);
    EXPECT(!class_info && alive == 0);
    puts("the extension has its points");
    return 0;
}
