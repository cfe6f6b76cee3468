/* The class StrewNative of Godot 4: points of libstrew as buffers of a MultiMesh. See ../README.md.
 *
 * It is written against Godot's own C interface, so that it compiles in a second without godot-cpp. All objects share
 * one library; each keeps the words of its last error, so that threads of a pool use one object each. */

#include <stdlib.h>
#include <string.h>

#include <gdextension_interface.h>
#include <strew.h>

#define EXPORT __attribute__((visibility("default")))
#if defined(_WIN32)
#undef EXPORT
#define EXPORT __declspec(dllexport)
#endif

/* Room for a String, a StringName, or a packed array: 16 bytes at most. */
typedef union {
    void *align;
    char bytes[16];
} opaque;

/* The functions of Godot that are used. */
static struct {
    GDExtensionInterfaceClassdbRegisterExtensionClass2 register_class;
    GDExtensionInterfaceClassdbRegisterExtensionClassMethod register_method;
    GDExtensionInterfaceClassdbUnregisterExtensionClass unregister_class;
    GDExtensionInterfaceClassdbConstructObject construct_object;
    GDExtensionInterfaceObjectSetInstance set_instance;
    GDExtensionInterfaceStringNameNewWithLatin1Chars new_name;
    GDExtensionInterfaceStringNewWithUtf8Chars new_string;
    GDExtensionInterfaceStringToUtf8Chars string_to_utf8;
    GDExtensionInterfacePackedFloat32ArrayOperatorIndex float_at;
    GDExtensionInterfaceVariantGetType type_of;
    GDExtensionPtrBuiltInMethod resize;
    GDExtensionPtrConstructor new_floats;
    GDExtensionPtrDestructor free_floats;
    GDExtensionPtrDestructor free_string;
    GDExtensionPtrDestructor free_name;
    GDExtensionVariantFromTypeConstructorFunc variant_of_floats;
    GDExtensionVariantFromTypeConstructorFunc variant_of_string;
    GDExtensionTypeFromVariantConstructorFunc to_string;
    GDExtensionTypeFromVariantConstructorFunc to_float;
    GDExtensionTypeFromVariantConstructorFunc to_int;
} godot;

static GDExtensionClassLibraryPtr extension;
static strew_library *library;

/* An object of the class. */
typedef struct {
    char *message;
} native;

static void say(native *self, const char *message) {
    free(self->message);
    self->message = malloc(strlen(message) + 1);
    if (self->message) strcpy(self->message, message);
}

/* A copy of a String, or null without memory. */
static char *utf8(GDExtensionConstStringPtr text) {
    GDExtensionInt length = godot.string_to_utf8(text, NULL, 0);
    char *copy = malloc((size_t)length + 1);
    if (!copy) return NULL;
    godot.string_to_utf8(text, copy, length);
    copy[length] = 0;
    return copy;
}

/* Copies a document of floats to the end of a plan's life; the array stays empty after an error. */
static void fill(native *self, strew_code code, strew_plan *plan, GDExtensionTypePtr floats) {
    strew_bytes *document = NULL;
    if (code == STREW_OK) code = strew_plan_document(plan, "format=multimesh", &document);
    say(self, code == STREW_OK ? "" : strew_error_message());
    if (code == STREW_OK) {
        size_t length = strew_bytes_length(document);
        int64_t size = (int64_t)(length / sizeof(float)), failed = 0;
        GDExtensionConstTypePtr arguments[] = {&size};
        godot.resize(floats, arguments, &failed, 1);
        /* The document is little endian, as all processors are that Godot runs on. */
        if (failed != 0) say(self, "no memory for the points");
        else if (size > 0) memcpy(godot.float_at(floats, 0), strew_bytes_data(document), length);
    }
    strew_bytes_free(document);
    strew_plan_free(plan);
}

/* chunk(query: String, side: float, column: int, row: int) -> PackedFloat32Array */
static void chunk(native *self, const GDExtensionConstTypePtr *arguments, GDExtensionTypePtr result) {
    char *query = utf8(arguments[0]);
    strew_plan *plan = NULL;
    const int64_t at[2] = {*(const int64_t *)arguments[2], *(const int64_t *)arguments[3]};
    strew_code code = strew_plan_chunk(library, 2, query, *(const double *)arguments[1], at, &plan);
    fill(self, code, plan, result);
    free(query);
}

/* region(query: String) -> PackedFloat32Array */
static void region(native *self, const GDExtensionConstTypePtr *arguments, GDExtensionTypePtr result) {
    char *query = utf8(arguments[0]);
    strew_plan *plan = NULL;
    fill(self, strew_plan_query(library, 2, query, &plan), plan, result);
    free(query);
}

/* message() -> String */
static void message(native *self, const GDExtensionConstTypePtr *arguments, GDExtensionTypePtr result) {
    (void)arguments;
    godot.free_string(result);
    godot.new_string(result, self->message ? self->message : "");
}

/* A method: its name, function, arguments and result. Results are constructed before the function is called. */
typedef struct {
    const char *name;
    void (*call)(native *, const GDExtensionConstTypePtr *, GDExtensionTypePtr);
    GDExtensionVariantType result;
    int count;
    struct {
        const char *name;
        GDExtensionVariantType type;
    } arguments[4];
} method;

static const method methods[] = {
    {"chunk", chunk, GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY, 4,
     {{"query", GDEXTENSION_VARIANT_TYPE_STRING}, {"side", GDEXTENSION_VARIANT_TYPE_FLOAT},
      {"column", GDEXTENSION_VARIANT_TYPE_INT}, {"row", GDEXTENSION_VARIANT_TYPE_INT}}},
    {"region", region, GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY, 1,
     {{"query", GDEXTENSION_VARIANT_TYPE_STRING}}},
    {"message", message, GDEXTENSION_VARIANT_TYPE_STRING, 0, {{NULL, GDEXTENSION_VARIANT_TYPE_NIL}}},
};
#define METHODS (sizeof methods / sizeof *methods)

/* A call with typed arguments. */
static void call_typed(void *data, GDExtensionClassInstancePtr self, const GDExtensionConstTypePtr *arguments,
                       GDExtensionTypePtr result) {
    ((const method *)data)->call(self, arguments, result);
}

/* A call with Variants, whose number and types are checked. An integer is taken for a float. */
static void call(void *data, GDExtensionClassInstancePtr self, const GDExtensionConstVariantPtr *given,
                 GDExtensionInt count, GDExtensionVariantPtr result, GDExtensionCallError *error) {
    const method *called = data;
    opaque values[4];
    GDExtensionConstTypePtr arguments[4];
    if (count != called->count) {
        error->error = count < called->count ? GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS
                                             : GDEXTENSION_CALL_ERROR_TOO_MANY_ARGUMENTS;
        error->argument = error->expected = called->count;
        return;
    }
    for (int i = 0; i < called->count; i++) {
        GDExtensionVariantType type = called->arguments[i].type, has = godot.type_of(given[i]);
        if (has != type && !(type == GDEXTENSION_VARIANT_TYPE_FLOAT && has == GDEXTENSION_VARIANT_TYPE_INT)) {
            error->error = GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT;
            error->argument = i;
            error->expected = type;
            return;
        }
    }
    for (int i = 0; i < called->count; i++) {
        GDExtensionVariantType type = called->arguments[i].type, has = godot.type_of(given[i]);
        arguments[i] = &values[i];
        if (type == GDEXTENSION_VARIANT_TYPE_STRING) {
            godot.to_string(&values[i], (GDExtensionVariantPtr)given[i]);
        } else if (has == GDEXTENSION_VARIANT_TYPE_FLOAT) {
            godot.to_float(&values[i], (GDExtensionVariantPtr)given[i]);
        } else {
            int64_t whole = 0;
            godot.to_int(&whole, (GDExtensionVariantPtr)given[i]);
            double number = (double)whole;
            memcpy(&values[i], type == GDEXTENSION_VARIANT_TYPE_FLOAT ? (void *)&number : (void *)&whole, 8);
        }
    }
    opaque made;
    if (called->result == GDEXTENSION_VARIANT_TYPE_STRING) {
        godot.new_string(&made, "");
        called->call(self, arguments, &made);
        godot.variant_of_string(result, &made);
        godot.free_string(&made);
    } else {
        godot.new_floats(&made, NULL);
        called->call(self, arguments, &made);
        godot.variant_of_floats(result, &made);
        godot.free_floats(&made);
    }
    for (int i = 0; i < called->count; i++)
        if (called->arguments[i].type == GDEXTENSION_VARIANT_TYPE_STRING) godot.free_string(&values[i]);
    error->error = GDEXTENSION_CALL_OK;
}

static GDExtensionObjectPtr create(void *data) {
    (void)data;
    opaque base, own;
    native *self = calloc(1, sizeof *self);
    godot.new_name(&base, "RefCounted", 0);
    godot.new_name(&own, "StrewNative", 0);
    GDExtensionObjectPtr object = godot.construct_object(&base);
    godot.set_instance(object, &own, self);
    godot.free_name(&own);
    godot.free_name(&base);
    return object;
}

static void destroy(void *data, GDExtensionClassInstancePtr instance) {
    (void)data;
    native *self = instance;
    free(self->message);
    free(self);
}

static GDExtensionPropertyInfo typed(GDExtensionVariantType type, opaque *name, opaque *empty, opaque *hint) {
    GDExtensionPropertyInfo info = {type, name, empty, 0, hint, 6 /* stored and shown */};
    return info;
}

static void add_method(const method *added, opaque *class_name, opaque *empty, opaque *hint) {
    opaque name, names[4];
    GDExtensionPropertyInfo arguments[4], result = typed(added->result, empty, empty, hint);
    GDExtensionClassMethodArgumentMetadata metadata[4] = {GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE};
    godot.new_name(&name, added->name, 0);
    for (int i = 0; i < added->count; i++) {
        godot.new_name(&names[i], added->arguments[i].name, 0);
        arguments[i] = typed(added->arguments[i].type, &names[i], empty, hint);
    }
    GDExtensionClassMethodInfo info = {
        .name = &name,
        .method_userdata = (void *)added,
        .call_func = call,
        .ptrcall_func = call_typed,
        .method_flags = GDEXTENSION_METHOD_FLAGS_DEFAULT,
        .has_return_value = 1,
        .return_value_info = &result,
        .argument_count = (uint32_t)added->count,
        .arguments_info = arguments,
        .arguments_metadata = metadata,
    };
    godot.register_method(extension, class_name, &info);
    for (int i = 0; i < added->count; i++) godot.free_name(&names[i]);
    godot.free_name(&name);
}

static void initialize(void *data, GDExtensionInitializationLevel level) {
    (void)data;
    if (level != GDEXTENSION_INITIALIZATION_SCENE || strew_library_open(NULL, &library) != STREW_OK) return;
    opaque name, base, empty, hint;
    godot.new_name(&name, "StrewNative", 0);
    godot.new_name(&base, "RefCounted", 0);
    godot.new_name(&empty, "", 0);
    godot.new_string(&hint, "");
    GDExtensionClassCreationInfo2 info = {
        .is_exposed = 1,
        .create_instance_func = create,
        .free_instance_func = destroy,
    };
    godot.register_class(extension, &name, &base, &info);
    for (size_t i = 0; i < METHODS; i++) add_method(&methods[i], &name, &empty, &hint);
    godot.free_string(&hint);
    godot.free_name(&empty);
    godot.free_name(&base);
    godot.free_name(&name);
}

static void deinitialize(void *data, GDExtensionInitializationLevel level) {
    (void)data;
    if (level != GDEXTENSION_INITIALIZATION_SCENE || !library) return;
    opaque name;
    godot.new_name(&name, "StrewNative", 0);
    godot.unregister_class(extension, &name);
    godot.free_name(&name);
    strew_library_free(library);
    library = NULL;
}

/* Finds a function of Godot, and ends the start if it is missing. */
#define FIND(place, type, name)                   \
    do {                                          \
        place = (type)(void (*)(void))find(name); \
        if (!place) return 0;                     \
    } while (0)

EXPORT GDExtensionBool strew_native_init(GDExtensionInterfaceGetProcAddress find, GDExtensionClassLibraryPtr own,
                                         GDExtensionInitialization *start) {
    GDExtensionInterfaceVariantGetPtrBuiltinMethod builtin;
    GDExtensionInterfaceVariantGetPtrConstructor constructor;
    GDExtensionInterfaceVariantGetPtrDestructor destructor;
    GDExtensionInterfaceGetVariantFromTypeConstructor from_type;
    GDExtensionInterfaceGetVariantToTypeConstructor to_type;
    FIND(godot.register_class, GDExtensionInterfaceClassdbRegisterExtensionClass2,
         "classdb_register_extension_class2");
    FIND(godot.register_method, GDExtensionInterfaceClassdbRegisterExtensionClassMethod,
         "classdb_register_extension_class_method");
    FIND(godot.unregister_class, GDExtensionInterfaceClassdbUnregisterExtensionClass,
         "classdb_unregister_extension_class");
    FIND(godot.construct_object, GDExtensionInterfaceClassdbConstructObject, "classdb_construct_object");
    FIND(godot.set_instance, GDExtensionInterfaceObjectSetInstance, "object_set_instance");
    FIND(godot.new_name, GDExtensionInterfaceStringNameNewWithLatin1Chars, "string_name_new_with_latin1_chars");
    FIND(godot.new_string, GDExtensionInterfaceStringNewWithUtf8Chars, "string_new_with_utf8_chars");
    FIND(godot.string_to_utf8, GDExtensionInterfaceStringToUtf8Chars, "string_to_utf8_chars");
    FIND(godot.float_at, GDExtensionInterfacePackedFloat32ArrayOperatorIndex, "packed_float32_array_operator_index");
    FIND(godot.type_of, GDExtensionInterfaceVariantGetType, "variant_get_type");
    FIND(builtin, GDExtensionInterfaceVariantGetPtrBuiltinMethod, "variant_get_ptr_builtin_method");
    FIND(constructor, GDExtensionInterfaceVariantGetPtrConstructor, "variant_get_ptr_constructor");
    FIND(destructor, GDExtensionInterfaceVariantGetPtrDestructor, "variant_get_ptr_destructor");
    FIND(from_type, GDExtensionInterfaceGetVariantFromTypeConstructor, "get_variant_from_type_constructor");
    FIND(to_type, GDExtensionInterfaceGetVariantToTypeConstructor, "get_variant_to_type_constructor");

    opaque name;
    godot.new_name(&name, "resize", 0);
    /* The hash of `resize` in extension_api.json. */
    godot.resize = builtin(GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY, &name, 848867239);
    godot.new_floats = constructor(GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY, 0);
    godot.free_floats = destructor(GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY);
    godot.free_string = destructor(GDEXTENSION_VARIANT_TYPE_STRING);
    godot.free_name = destructor(GDEXTENSION_VARIANT_TYPE_STRING_NAME);
    godot.variant_of_floats = from_type(GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY);
    godot.variant_of_string = from_type(GDEXTENSION_VARIANT_TYPE_STRING);
    godot.to_string = to_type(GDEXTENSION_VARIANT_TYPE_STRING);
    godot.to_float = to_type(GDEXTENSION_VARIANT_TYPE_FLOAT);
    godot.to_int = to_type(GDEXTENSION_VARIANT_TYPE_INT);
    if (!godot.resize) return 0;
    godot.free_name(&name);

    extension = own;
    start->minimum_initialization_level = GDEXTENSION_INITIALIZATION_SCENE;
    start->initialize = initialize;
    start->deinitialize = deinitialize;
    return 1;
}
