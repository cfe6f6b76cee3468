// The chunks around a place: which are there, which are made now, which are forgotten.
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Threading.Tasks;

namespace Strew
{
    /// <summary>A column and a row of the world grid.</summary>
    public struct Cell : IEquatable<Cell>
    {
        public readonly long Column;
        public readonly long Row;

        public Cell(long column, long row)
        {
            Column = column;
            Row = row;
        }

        /// <summary>The greater of the distances in columns and rows.</summary>
        public long From(Cell other) => Math.Max(Math.Abs(Column - other.Column), Math.Abs(Row - other.Row));

        public bool Equals(Cell other) => Column == other.Column && Row == other.Row;

        public override bool Equals(object other) => other is Cell cell && Equals(cell);

        public override int GetHashCode() => unchecked((int)(Column * 31 + Row));
    }

    /// <summary>Makes chunks around a place in tasks, and forgets those that are far. It knows no engine:
    /// <c>make</c> turns a plan into what the caller draws.</summary>
    public sealed class Chunks<T>
    {
        private readonly Func<long, long, T> make;
        private readonly Dictionary<Cell, T> there = new Dictionary<Cell, T>();
        private readonly HashSet<Cell> underWay = new HashSet<Cell>();
        private readonly ConcurrentQueue<Made> finished = new ConcurrentQueue<Made>();

        private struct Made
        {
            internal Cell Cell;
            internal T Chunk;
            internal Exception Failure;
        }

        /// <param name="size">The side of a chunk.</param>
        /// <param name="reach">Chunks are made this far around the one of the place.</param>
        /// <param name="make">Makes a chunk of a column and row, in a task.</param>
        public Chunks(double size, int reach, Func<long, long, T> make)
        {
            Size = size;
            Reach = reach;
            this.make = make;
        }

        /// <summary>The side of a chunk.</summary>
        public double Size { get; }

        /// <summary>Chunks are made this far around the one of the place.</summary>
        public int Reach { get; }

        /// <summary>The chunks that are there.</summary>
        public IEnumerable<KeyValuePair<Cell, T>> There => there;

        /// <summary>Whether nothing is being made.</summary>
        public bool IsComplete => underWay.Count == 0;

        /// <summary>Takes finished chunks, starts missing ones, and forgets those beyond twice the reach. Call it
        /// once a frame, always from one thread.</summary>
        /// <exception cref="StrewException">The query of a chunk was refused.</exception>
        public void Around(double x, double y)
        {
            var here = new Cell((long)Math.Floor(x / Size), (long)Math.Floor(y / Size));
            while (finished.TryDequeue(out Made done))
            {
                underWay.Remove(done.Cell);
                if (done.Failure != null) throw done.Failure;
                there[done.Cell] = done.Chunk;
            }
            foreach (Cell cell in new List<Cell>(there.Keys))
                if (cell.From(here) > 2 * Reach) there.Remove(cell);
            for (long row = here.Row - Reach; row <= here.Row + Reach; row++)
                for (long column = here.Column - Reach; column <= here.Column + Reach; column++)
                {
                    var cell = new Cell(column, row);
                    if (!there.ContainsKey(cell) && underWay.Add(cell)) Task.Run(() => Finish(cell));
                }
        }

        private void Finish(Cell cell)
        {
            var made = new Made { Cell = cell };
            try
            {
                made.Chunk = make(cell.Column, cell.Row);
            }
            catch (Exception failure)
            {
                made.Failure = failure;
            }
            finished.Enqueue(made);
        }
    }
}
