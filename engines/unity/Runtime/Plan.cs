// A planned query: its points are counted, and made when they are wanted.
using System;

namespace Strew
{
    /// <summary>A planned query of the plane. Threads may share one.</summary>
    public sealed class Plan : IDisposable
    {
        private readonly PlanHandle handle;

        internal Plan(PlanHandle handle)
        {
            this.handle = handle;
            StrewException.Check(Native.strew_plan_count(handle, out ulong count));
            Count = checked((int)count);
        }

        /// <summary>The number of points.</summary>
        public int Count { get; }

        private static UIntPtr Capacity(Array numbers) => (UIntPtr)(uint)numbers.Length;

        /// <summary>The place that the numbers of <see cref="Positions"/> are relative to: x, y.</summary>
        public double[] Origin()
        {
            var origin = new double[2];
            StrewException.Check(Native.strew_plan_origin(handle, origin));
            return origin;
        }

        /// <summary>x and y of each point, by turns.</summary>
        public double[] Positions()
        {
            var xy = new double[2 * Count];
            StrewException.Check(Native.strew_plan_fill_coordinates(handle, xy, Capacity(xy)));
            return xy;
        }

        /// <summary>x and y of each point, by turns, from the lower corner of the region or chunk.</summary>
        /// <param name="origin">That corner: x, y.</param>
        public float[] Offsets(out double[] origin)
        {
            var xy = new float[2 * Count];
            origin = new double[2];
            StrewException.Check(Native.strew_plan_fill_coordinates_f32(handle, xy, Capacity(xy), origin));
            return xy;
        }

        /// <summary>Writes what <see cref="Offsets"/> returns to memory that is not an array's.</summary>
        /// <param name="xy">Room for two floats of each point, such as
        /// <c>(IntPtr)NativeArrayUnsafeUtility.GetUnsafePtr(array)</c>.</param>
        /// <param name="capacity">The floats that there is room for.</param>
        /// <exception cref="StrewException">There is too little room.</exception>
        public double[] WriteOffsets(IntPtr xy, int capacity)
        {
            var origin = new double[2];
            var room = (UIntPtr)(uint)capacity;
            StrewException.Check(Native.strew_plan_fill_coordinates_f32_at(handle, xy, room, origin));
            return origin;
        }

        /// <summary>The stable ids: two integers of each point, by turns.</summary>
        public long[] Ids()
        {
            var ids = new long[2 * Count];
            StrewException.Check(Native.strew_plan_fill_ids(handle, ids, Capacity(ids)));
            return ids;
        }

        /// <summary>A column of numbers that the query names in attributes, such as angle or scale.</summary>
        public double[] Numbers(string column)
        {
            var values = new double[Count];
            StrewException.Check(
                Native.strew_plan_fill_numbers(handle, Library.Utf8(column), values, Capacity(values)));
            return values;
        }

        /// <summary>A column of names, such as variant: indices into the names in alphabetical order, or -1.</summary>
        public int[] Codes(string column)
        {
            var codes = new int[Count];
            StrewException.Check(Native.strew_plan_fill_codes(handle, Library.Utf8(column), codes, Capacity(codes)));
            return codes;
        }

        /// <summary>Frees the plan.</summary>
        public void Dispose() => handle.Dispose();
    }
}
