// The calls of libstrew, as strew.h declares them. Nothing outside of this assembly sees them.
using System;
using System.Runtime.InteropServices;

namespace Strew
{
    internal static class Native
    {
#if UNITY_IOS && !UNITY_EDITOR
        private const string Library = "__Internal";
#else
        private const string Library = "strew";
#endif

        [DllImport(Library)]
        internal static extern IntPtr strew_version();

        [DllImport(Library)]
        internal static extern Code strew_library_open(byte[] folder, out LibraryHandle library);

        [DllImport(Library)]
        internal static extern void strew_library_free(IntPtr library);

        [DllImport(Library)]
        internal static extern Code strew_plan_query(LibraryHandle library, uint axes, byte[] query, out PlanHandle plan);

        [DllImport(Library)]
        internal static extern Code strew_plan_chunk(
            LibraryHandle library, uint axes, byte[] query, double size, long[] at, out PlanHandle plan);

        [DllImport(Library)]
        internal static extern void strew_plan_free(IntPtr plan);

        [DllImport(Library)]
        internal static extern Code strew_plan_count(PlanHandle plan, out ulong count);

        [DllImport(Library)]
        internal static extern Code strew_plan_origin(PlanHandle plan, [Out] double[] origin);

        [DllImport(Library)]
        internal static extern Code strew_plan_fill_coordinates(PlanHandle plan, [Out] double[] xy, UIntPtr capacity);

        [DllImport(Library)]
        internal static extern Code strew_plan_fill_coordinates_f32(
            PlanHandle plan, [Out] float[] xy, UIntPtr capacity, [Out] double[] origin);

        // For memory that is not an array, such as a NativeArray's.
        [DllImport(Library, EntryPoint = "strew_plan_fill_coordinates_f32")]
        internal static extern Code strew_plan_fill_coordinates_f32_at(
            PlanHandle plan, IntPtr xy, UIntPtr capacity, [Out] double[] origin);

        [DllImport(Library)]
        internal static extern Code strew_plan_fill_ids(PlanHandle plan, [Out] long[] ids, UIntPtr capacity);

        [DllImport(Library)]
        internal static extern Code strew_plan_fill_numbers(
            PlanHandle plan, byte[] column, [Out] double[] values, UIntPtr capacity);

        [DllImport(Library)]
        internal static extern Code strew_plan_fill_codes(
            PlanHandle plan, byte[] column, [Out] int[] codes, UIntPtr capacity);

        [DllImport(Library)]
        internal static extern IntPtr strew_error_message();

        [DllImport(Library)]
        internal static extern IntPtr strew_error_kind();

        [DllImport(Library)]
        internal static extern IntPtr strew_error_field();

        [DllImport(Library)]
        internal static extern IntPtr strew_error_document();
    }
}
