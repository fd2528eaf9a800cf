roscell_needs(Threads)
