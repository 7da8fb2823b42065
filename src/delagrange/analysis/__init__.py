"""What a run or a sweep shows: one diagnostic a file."""
