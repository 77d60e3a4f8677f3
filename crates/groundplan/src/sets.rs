//! Sets that only ever join.

/// Sets that only ever join (union-find): each has the name of one of its members.
pub struct Sets(Vec<u32>);

impl Sets {
    /// So many sets of one.
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// One more, and its name.
    pub fn add(&mut self) -> u32 {
        self.0.push(self.0.len() as u32);
        self.0.len() as u32 - 1
    }

    /// The name of the set that holds a member.
    pub fn of(&mut self, mut member: u32) -> u32 {
        while self.0[member as usize] != member {
            let above = self.0[self.0[member as usize] as usize];
            self.0[member as usize] = above;
            member = above;
        }
        member
    }

    /// The same, of sets that others ask too.
    pub fn name(&self, mut member: u32) -> u32 {
        while self.0[member as usize] != member {
            member = self.0[member as usize];
        }
        member
    }

    /// Joins the set named `other` to the one named `to`.
    pub fn join(&mut self, to: u32, other: u32) {
        self.0[other as usize] = to;
    }

    /// Joins the sets of two members under the name that comes first.
    pub fn join_first(&mut self, one: u32, other: u32) {
        let (one, other) = (self.of(one), self.of(other));
        self.join(one.min(other), one.max(other));
    }

    /// The number of each member's set, from 1 in the order of the names, and how many sets there are.
    pub fn numbered(mut self) -> (Vec<u32>, usize) {
        let mut count = 0;
        // A name comes before all other members of its set.
        for n in 0..self.0.len() {
            let above = self.0[n] as usize;
            self.0[n] = if above == n {
                count += 1;
                count
            } else {
                self.0[above]
            };
        }
        (self.0, count as usize)
    }
}
