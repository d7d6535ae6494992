//! Tokens to a typed tree, in one pass: every node is checked where it is made.

use super::token::{Token, TokenKind, tokens};
use super::tree::{Field, Kind, Node, OfPair, OfParticle, Operator, Particle, Units};
use super::{LanguageError, operators};
use crate::exact::int;
use crate::names::nearest;
use num_traits::Zero;
use std::ops::Range;

/// Deeper nesting is refused, so that no text can exhaust the stack.
const MOST_DEPTH: usize = 64;
/// Tensors of higher rank are refused.
const MOST_RANK: u8 = 8;
/// Larger trees are refused.
const MOST_NODES: usize = 4096;
/// More sums inside each other are refused.
const MOST_SUMS: usize = 4;
/// Higher powers are refused.
const MOST_POWER: i32 = 12;

/// Names that stand without an index, with one particle, and with a pair.
const PLAIN: [&str; 4] = ["D", "h", "I", "pi"];
const ONE: [&str; 8] = ["u", "v", "V", "rho", "m", "mu", "B", "Bhat"];
const PAIR: [&str; 6] = ["r", "e", "W", "gradW", "gradgradW", "lapW"];
const BINDERS: [&str; 3] = ["sum", "count", "mean"];

type Parsed = Result<Node, LanguageError>;

impl Operator {
    /// Reads an operator.
    ///
    /// # Errors
    /// [`LanguageError`] with the bytes at fault: what cannot be read, an index that is not bound, ranks or units that do
    /// not match, an expression that is not linear in the field.
    ///
    /// # Examples
    /// ```
    /// use remainder::language::Operator;
    /// let f4 = Operator::parse("sum_j V_j (u_j - u_i) B_i . gradW_ij").unwrap();
    /// assert_eq!(f4.rank(), 1);
    /// let error = Operator::parse("sum_j V_j u_j u_j gradW_ij").unwrap_err();
    /// assert!(error.message.contains("not linear"));
    /// ```
    pub fn parse(text: &str) -> Result<Self, LanguageError> {
        let (tree, field) = Self::read(text)?;
        let Some(field) = field.filter(|_| tree.root.linear) else {
            return Err(LanguageError::new(0..text.len(), "contains no field")
                .with_help("an operator is linear in u_j, or in the vector v_j"));
        };
        Ok(Self { field, ..tree })
    }

    /// Reads a tensor that contains no field, such as one term of a printed truncation error.
    ///
    /// # Errors
    /// [`LanguageError`], as [`Operator::parse`].
    pub fn parse_coefficient(text: &str) -> Result<Self, LanguageError> {
        let (tree, field) = Self::read(text)?;
        if field.is_some() {
            return Err(LanguageError::new(0..text.len(), "contains the field: a coefficient is free of it"));
        }
        Ok(tree)
    }

    fn read(text: &str) -> Result<(Self, Option<Field>), LanguageError> {
        let mut shared = Shared { particles: vec!['i'], field: None, nodes: 0, depth: 0 };
        let scope = vec![('i', 0)];
        let mut parser = Parser { tokens: tokens(text)?, at: 0, scope, inlined: None, shared: &mut shared };
        let root = parser.whole()?;
        let field = shared.field;
        let particles = shared.particles;
        Ok((Self { text: text.to_owned(), field: Field::Scalar, root, particles }, field))
    }
}

/// What an operator and those applied inside it have in common.
struct Shared {
    particles: Vec<char>,
    field: Option<Field>,
    nodes: usize,
    depth: usize,
}

struct Parser<'a> {
    tokens: Vec<Token>,
    at: usize,
    /// The particles bound here, innermost last.
    scope: Vec<(char, Particle)>,
    /// Where this text stands in the outer one, if it is an operator applied inside another.
    inlined: Option<Range<usize>>,
    shared: &'a mut Shared,
}

impl Parser<'_> {
    fn whole(&mut self) -> Parsed {
        let root = self.sum_of_terms()?;
        match &self.peek().kind {
            TokenKind::End => Ok(root),
            _ => Err(self.unexpected("the end of the operator, or a sign")),
        }
    }

    fn peek(&self) -> &Token {
        &self.tokens[self.at.min(self.tokens.len() - 1)]
    }

    fn is(&self, symbol: char) -> bool {
        self.peek().kind == TokenKind::Symbol(symbol)
    }

    fn take(&mut self, symbol: char) -> bool {
        let found = self.is(symbol);
        self.at += usize::from(found);
        found
    }

    fn expect(&mut self, symbol: char, opened: &Range<usize>) -> Result<(), LanguageError> {
        if self.take(symbol) {
            return Ok(());
        }
        let error = self.unexpected(&format!("'{symbol}'"));
        Err(error.with_help(format!("it closes what was opened at byte {}", opened.start + 1)))
    }

    fn unexpected(&self, expected: &str) -> LanguageError {
        let found = match &self.peek().kind {
            TokenKind::End => "the end of the text".to_owned(),
            TokenKind::Symbol(symbol) => format!("'{symbol}'"),
            TokenKind::Number(value) => format!("the number {value}"),
            TokenKind::Name(name, _) => format!("'{name}'"),
        };
        LanguageError::new(self.here(), format!("expected {expected}, found {found}"))
    }

    fn here(&self) -> Range<usize> {
        self.inlined.clone().unwrap_or_else(|| self.peek().span.clone())
    }

    fn span(&self, from: &Range<usize>, to: &Range<usize>) -> Range<usize> {
        self.inlined.clone().unwrap_or(from.start..to.end)
    }

    /// Makes a node, and counts it.
    fn node(&mut self, kind: Kind, rank: u8, linear: bool, units: Units, span: Range<usize>) -> Parsed {
        self.shared.nodes += 1;
        if self.shared.nodes > MOST_NODES {
            return Err(LanguageError::new(span, format!("more than {MOST_NODES} operations")));
        }
        if rank > MOST_RANK {
            return Err(LanguageError::new(span, format!("a tensor of rank {rank}: at most {MOST_RANK}")));
        }
        Ok(Node { kind, rank, linear, units, span })
    }

    fn deeper<T>(
        &mut self,
        parse: impl FnOnce(&mut Self) -> Result<T, LanguageError>,
    ) -> Result<T, LanguageError> {
        if self.shared.depth >= MOST_DEPTH {
            return Err(LanguageError::new(self.here(), format!("nested more than {MOST_DEPTH} deep")));
        }
        self.shared.depth += 1;
        let result = parse(self);
        self.shared.depth -= 1;
        result
    }

    /// term (('+' | '-') term)*
    fn sum_of_terms(&mut self) -> Parsed {
        self.deeper(|parser| {
            let mut terms = vec![parser.signed_term()?];
            loop {
                let negative = match (parser.take('+'), parser.is('-')) {
                    (true, _) => false,
                    (_, true) => parser.take('-'),
                    _ => break,
                };
                let term = parser.signed_term()?;
                terms.push(if negative { parser.negated(term)? } else { term });
            }
            parser.added(terms)
        })
    }

    fn negated(&mut self, a: Node) -> Parsed {
        let (rank, linear, units, span) = (a.rank, a.linear, a.units, a.span.clone());
        self.node(Kind::Negate(Box::new(a)), rank, linear, units, span)
    }

    fn added(&mut self, mut terms: Vec<Node>) -> Parsed {
        if terms.len() == 1 {
            return Ok(terms.remove(0));
        }
        let first = &terms[0];
        for term in &terms[1..] {
            let fault = |message: String| LanguageError::new(term.span.clone(), message);
            if term.rank != first.rank {
                return Err(fault(format!(
                    "a tensor of rank {} is added to one of rank {}",
                    term.rank, first.rank
                )));
            }
            if term.linear != first.linear {
                return Err(fault("a term with the field is added to one without: not linear".into()));
            }
            if term.units != first.units {
                return Err(fault(format!("{} is added to {}", describe(term.units), describe(first.units))));
            }
        }
        let (rank, linear, units) = (first.rank, first.linear, first.units);
        let span = self.span(&first.span, &terms[terms.len() - 1].span);
        self.node(Kind::Add(terms), rank, linear, units, span)
    }

    fn signed_term(&mut self) -> Parsed {
        if self.take('-') {
            let term = self.deeper(Self::signed_term)?;
            return self.negated(term);
        }
        self.take('+');
        self.term()
    }

    /// product (('.' | ':') product)*
    fn term(&mut self) -> Parsed {
        let mut left = self.product()?;
        loop {
            let count = match (self.take('.'), self.is(':')) {
                (true, _) => 1,
                (_, true) => {
                    self.take(':');
                    2
                }
                _ => return Ok(left),
            };
            let right = self.product()?;
            let span = self.span(&left.span, &right.span);
            for (side, node) in [("left", &left), ("right", &right)] {
                if node.rank < count {
                    let sign = if count == 1 { "." } else { ":" };
                    let message = format!(
                        "'{sign}' contracts {count} ind{} of each side, and its {side} side has rank {}",
                        if count == 1 { "ex" } else { "ices" },
                        node.rank
                    );
                    return Err(LanguageError::new(node.span.clone(), message));
                }
            }
            let (linear, units) = self.multiplied(&left, &right, &span)?;
            let rank = left.rank + right.rank - 2 * count;
            let kind = Kind::Contract(Box::new(left), Box::new(right), count);
            left = self.node(kind, rank, linear, units, span)?;
        }
    }

    fn multiplied(&self, a: &Node, b: &Node, span: &Range<usize>) -> Result<(bool, Units), LanguageError> {
        if a.linear && b.linear {
            return Err(LanguageError::new(span.clone(), "not linear: both factors contain the field"));
        }
        Ok((a.linear || b.linear, a.units.times(b.units, 1)))
    }

    /// power (['*' | '/'] power)*
    fn product(&mut self) -> Parsed {
        let mut left = self.power()?;
        loop {
            if self.take('/') {
                let right = self.power()?;
                let span = self.span(&left.span, &right.span);
                if right.rank != 0 {
                    let message = format!("the divisor has rank {}, not 0", right.rank);
                    return Err(LanguageError::new(right.span, message));
                }
                if right.linear {
                    return Err(LanguageError::new(right.span, "not linear: the divisor contains the field"));
                }
                if matches!(&right.kind, Kind::Number(value) if value.is_zero()) {
                    return Err(LanguageError::new(right.span, "divides by zero"));
                }
                let (rank, linear, units) = (left.rank, left.linear, left.units.times(right.units, -1));
                left = self.node(Kind::Divide(Box::new(left), Box::new(right)), rank, linear, units, span)?;
                continue;
            }
            let starts = matches!(self.peek().kind, TokenKind::Name(..) | TokenKind::Number(_))
                || self.is('(')
                || self.is('|');
            if !self.take('*') && !starts {
                return Ok(left);
            }
            let right = self.power()?;
            let span = self.span(&left.span, &right.span);
            let (linear, units) = self.multiplied(&left, &right, &span)?;
            let rank = left.rank + right.rank;
            left = self.node(Kind::Outer(Box::new(left), Box::new(right)), rank, linear, units, span)?;
        }
    }

    /// atom ['^' integer]
    fn power(&mut self) -> Parsed {
        let base = self.atom()?;
        if !self.take('^') {
            return Ok(base);
        }
        let negative = self.take('-');
        let place = self.here();
        let TokenKind::Number(value) = &self.peek().kind else {
            return Err(self.unexpected("a whole number after '^'"));
        };
        let exponent = (1..=MOST_POWER).find(|n| *value == int(i64::from(*n)));
        let Some(exponent) = exponent else {
            return Err(LanguageError::new(
                place,
                format!("a power must be a whole number up to {MOST_POWER}"),
            ));
        };
        let end = self.peek().span.clone();
        self.at += 1;
        if base.rank != 0 {
            let message = format!("a tensor of rank {} has no power", base.rank);
            return Err(LanguageError::new(base.span, message).with_help("write |r_ij|^2 for r_ij . r_ij"));
        }
        if base.linear {
            return Err(LanguageError::new(base.span, "not linear: a power of the field"));
        }
        let exponent = if negative { -exponent } else { exponent };
        if negative && matches!(&base.kind, Kind::Number(value) if value.is_zero()) {
            return Err(LanguageError::new(base.span, "divides by zero"));
        }
        let (units, span) = (Units::default().times(base.units, exponent), self.span(&base.span, &end));
        self.node(Kind::Power(Box::new(base), exponent), 0, false, units, span)
    }

    fn atom(&mut self) -> Parsed {
        let token = self.peek().clone();
        let span = self.here();
        match token.kind {
            TokenKind::Number(value) => {
                self.at += 1;
                self.constant(Kind::Number(value), 0, Units::default(), span)
            }
            TokenKind::Symbol('(') => {
                self.at += 1;
                let inner = self.sum_of_terms()?;
                self.expect(')', &token.span)?;
                Ok(inner)
            }
            TokenKind::Symbol('|') => {
                self.at += 1;
                let separation = self.atom()?;
                let Kind::OfPair(OfPair::Separation, p, q) = separation.kind else {
                    return Err(LanguageError::new(separation.span, "only a distance stands between bars")
                        .with_help("write |r_ij|"));
                };
                self.expect('|', &token.span)?;
                let span = self.span(&token.span, &separation.span);
                self.constant(Kind::OfPair(OfPair::Distance, p, q), 0, separation.units, span)
            }
            TokenKind::Name(name, subscript) => {
                self.at += 1;
                self.named(&name, &subscript, &token.span)
            }
            _ => Err(self.unexpected("a quantity, a sum or a parenthesis")),
        }
    }

    fn constant(&mut self, kind: Kind, rank: u8, units: Units, span: Range<usize>) -> Parsed {
        self.node(kind, rank, false, units, span)
    }

    fn named(&mut self, name: &str, subscript: &str, place: &Range<usize>) -> Parsed {
        let span = self.inlined.clone().unwrap_or_else(|| place.clone());
        if self.is('[') && subscript.is_empty() {
            return self.applied(name, place);
        }
        let letters: Vec<char> = subscript.chars().collect();
        let wants = |count: usize| -> Result<(), LanguageError> {
            if letters.len() == count {
                return Ok(());
            }
            let (message, help) = match count {
                0 => (format!("{name} belongs to no particle"), format!("write {name}")),
                1 => (format!("{name} belongs to one particle"), format!("write {name}_j")),
                _ => (format!("{name} belongs to a pair"), format!("write {name}_ij")),
            };
            Err(LanguageError::new(span.clone(), message).with_help(help))
        };
        let unit = |length, volume, mass, viscosity| Units { length, volume, mass, viscosity };
        if PLAIN.contains(&name) {
            wants(0)?;
            let (kind, rank, units) = match name {
                "D" => (Kind::Dimension, 0, Units::default()),
                "h" => (Kind::SmoothingLength, 0, unit(1, 0, 0, 0)),
                "pi" => (Kind::Pi, 0, Units::default()),
                _ => (Kind::Identity, 2, Units::default()),
            };
            return self.constant(kind, rank, units, span);
        }
        if name == "inverse" {
            wants(0)?;
            return self.inverse(span);
        }
        if BINDERS.contains(&name) {
            wants(1)?;
            return self.binder(name, letters[0], span);
        }
        if ONE.contains(&name) {
            wants(1)?;
            let p = self.particle(letters[0], &span)?;
            let of = |quantity| Kind::OfParticle(quantity, p);
            return match name {
                "u" => self.field(Field::Scalar, p, span),
                "v" => self.field(Field::Vector, p, span),
                "V" => self.constant(of(OfParticle::Volume), 0, unit(0, 1, 0, 0), span),
                "rho" => self.constant(of(OfParticle::Density), 0, unit(0, -1, 1, 0), span),
                "m" => self.constant(of(OfParticle::Mass), 0, unit(0, 0, 1, 0), span),
                "mu" => self.constant(of(OfParticle::Viscosity), 0, unit(0, 0, 0, 1), span),
                "B" => self.constant(Kind::Renormalisation(p), 2, Units::default(), span),
                // Eq. (40): B̂ : Σ ω r e e ∇W, a pure number.
                _ => self.constant(Kind::RenormalisationHat(p), 2, Units::default(), span),
            };
        }
        if PAIR.contains(&name) {
            wants(2)?;
            let (p, q) = (self.particle(letters[0], &span)?, self.particle(letters[1], &span)?);
            if p == q {
                return Err(LanguageError::new(
                    span,
                    format!("{name}_{subscript} pairs a particle with itself"),
                ));
            }
            let (quantity, rank, units) = match name {
                "r" => (OfPair::Separation, 1, unit(1, 0, 0, 0)),
                "e" => (OfPair::Direction, 1, Units::default()),
                "W" => (OfPair::Kernel, 0, unit(0, -1, 0, 0)),
                "gradW" => (OfPair::Gradient, 1, unit(-1, -1, 0, 0)),
                "gradgradW" => (OfPair::Hessian, 2, unit(-2, -1, 0, 0)),
                _ => (OfPair::Laplacian, 0, unit(-2, -1, 0, 0)),
            };
            return self.constant(Kind::OfPair(quantity, p, q), rank, units, span);
        }
        let known: Vec<&str> = PLAIN.iter().chain(&ONE).chain(&PAIR).chain(&BINDERS).copied().collect();
        let error = LanguageError::new(span, format!("there is no quantity '{name}'"));
        Err(match (operators::by_id(name), nearest(name, &known)) {
            (Ok(_), _) => error.with_help(format!("to apply the operator {name}, write {name}[u]_i")),
            (_, Some(near)) => error.with_help(format!("did you mean {near}?")),
            _ => error.with_help(format!("there are {}", known.join(", "))),
        })
    }

    fn particle(&self, letter: char, span: &Range<usize>) -> Result<Particle, LanguageError> {
        let found = self.scope.iter().rev().find(|(name, _)| *name == letter);
        found.map(|(_, particle)| *particle).ok_or_else(|| {
            let bound: String = self.scope.iter().map(|(name, _)| *name).collect();
            LanguageError::new(span.clone(), format!("the index {letter} is not bound here"))
                .with_help(format!("sum over it with sum_{letter}, or use one of: {bound}"))
        })
    }

    fn field(&mut self, field: Field, p: Particle, span: Range<usize>) -> Parsed {
        match self.shared.field {
            Some(known) if known != field => {
                return Err(LanguageError::new(span, "one operator acts on u or on v, not on both"));
            }
            _ => self.shared.field = Some(field),
        }
        self.node(Kind::Field(p), field.rank(), true, Units::default(), span)
    }

    fn inverse(&mut self, span: Range<usize>) -> Parsed {
        let opened = self.peek().span.clone();
        if !self.take('(') {
            return Err(self.unexpected("'(' after inverse"));
        }
        let inner = self.sum_of_terms()?;
        self.expect(')', &opened)?;
        if inner.rank != 2 {
            let message = format!("only a tensor of rank 2 has an inverse, this has rank {}", inner.rank);
            return Err(LanguageError::new(inner.span, message));
        }
        if inner.linear {
            return Err(LanguageError::new(inner.span, "not linear: the inverse of the field"));
        }
        let units = Units::default().times(inner.units, -1);
        self.node(Kind::Inverse(Box::new(inner)), 2, false, units, span)
    }

    /// `sum_j term`, `mean_j term`, `count_j`.
    fn binder(&mut self, name: &str, letter: char, span: Range<usize>) -> Parsed {
        if self.scope.iter().any(|(known, _)| *known == letter) {
            let what = if letter == 'i' { "is the particle of the operator" } else { "is bound already" };
            return Err(
                LanguageError::new(span, format!("{letter} {what}")).with_help("sum over another letter")
            );
        }
        if self.scope.len() > MOST_SUMS {
            return Err(LanguageError::new(span, format!("more than {MOST_SUMS} sums inside each other")));
        }
        // A mean or a count without pairs is over the neighbours of the operator's own particle.
        let enclosing = self.scope[0].1;
        let bound = self.fresh(letter);
        if name == "count" {
            return self.counted(bound, enclosing, span);
        }
        self.scope.push((letter, bound));
        let body = self.deeper(Self::term)?;
        self.scope.pop();
        let centre = self.centre(bound, letter, &body, enclosing)?;
        let (rank, linear, units) = (body.rank, body.linear, body.units);
        let whole = self.span(&span, &body.span);
        let sum = Kind::Sum { bound, centre, body: Box::new(body) };
        let sum = self.node(sum, rank, linear, units, whole.clone())?;
        if name == "sum" {
            return Ok(sum);
        }
        let again = self.fresh(letter);
        let count = self.counted(again, centre, whole.clone())?;
        self.node(Kind::Divide(Box::new(sum), Box::new(count)), rank, linear, units, whole)
    }

    fn fresh(&mut self, letter: char) -> Particle {
        self.shared.particles.push(letter);
        self.shared.particles.len() - 1
    }

    fn counted(&mut self, bound: Particle, centre: Particle, span: Range<usize>) -> Parsed {
        let one = self.constant(Kind::Number(int(1)), 0, Units::default(), span.clone())?;
        self.constant(Kind::Sum { bound, centre, body: Box::new(one) }, 0, Units::default(), span)
    }

    /// Whose neighbours are summed over: the particle that the bound one is paired with.
    fn centre(
        &self,
        bound: Particle,
        letter: char,
        body: &Node,
        enclosing: Particle,
    ) -> Result<Particle, LanguageError> {
        let mut partners = Vec::new();
        partners_of(bound, body, &mut partners);
        partners.retain(|p| self.scope.iter().any(|(_, known)| known == p));
        partners.sort_unstable();
        partners.dedup();
        match partners[..] {
            [] => Ok(enclosing),
            [one] => Ok(one),
            _ => {
                let names: Vec<String> =
                    partners.iter().map(|p| self.shared.particles[*p].to_string()).collect();
                Err(LanguageError::new(
                    body.span.clone(),
                    format!(
                        "{letter} is paired with {}: whose neighbour it is cannot be told",
                        names.join(" and ")
                    ),
                )
                .with_help(format!("W, r, e of one pair only may have the index {letter}")))
            }
        }
    }

    /// `NAME[u]_p`: the operator NAME at particle p.
    fn applied(&mut self, name: &str, place: &Range<usize>) -> Parsed {
        let entry =
            operators::by_id(name).map_err(|error| LanguageError::new(place.clone(), error.to_string()))?;
        let opened = self.peek().span.clone();
        self.take('[');
        let (argument, subscript) = match self.peek().kind.clone() {
            TokenKind::Name(argument, subscript) => (argument, subscript),
            _ => return Err(self.unexpected("the field, u or v")),
        };
        if !subscript.is_empty() || !(argument == "u" || argument == "v") {
            let help = format!("write {name}[u]_i, or {name}[v]_i");
            return Err(
                LanguageError::new(self.here(), "only the field itself can be the argument").with_help(help)
            );
        }
        self.at += 1;
        self.expect(']', &opened)?;
        // `]_i` is two tokens: the bracket, then a name that is only a subscript.
        let letter = self.bare_subscript()?;
        let last = self.tokens[self.at - 1].span.clone();
        let span = self.span(place, &last);
        let p = self.particle(letter, &span)?;
        if entry.field.name() != argument {
            let message = format!("{name} acts on {}", entry.field.name());
            return Err(LanguageError::new(span, message));
        }
        let inner = tokens(entry.text)?;
        let scope = vec![('i', p)];
        let shared = &mut *self.shared;
        let mut parser = Parser { tokens: inner, at: 0, scope, inlined: Some(span.clone()), shared };
        let node = parser.deeper(Parser::whole)?;
        Ok(Node { span, ..node })
    }

    fn bare_subscript(&mut self) -> Result<char, LanguageError> {
        if self.take('_') {
            if let TokenKind::Name(letters, subscript) = &self.peek().kind {
                let mut letters = letters.chars();
                if let (Some(letter), None, true) = (letters.next(), letters.next(), subscript.is_empty()) {
                    self.at += 1;
                    return Ok(letter);
                }
            }
        }
        Err(self.unexpected("'_' and one particle index"))
    }
}

/// The other particles of the pairs that `bound` stands in.
fn partners_of(bound: Particle, node: &Node, partners: &mut Vec<Particle>) {
    if let Kind::OfPair(_, p, q) = node.kind {
        if p == bound {
            partners.push(q);
        } else if q == bound {
            partners.push(p);
        }
    }
    for child in node.children() {
        partners_of(bound, child, partners);
    }
}

/// For people.
fn describe(units: Units) -> String {
    let length = match (units.length, units.volume) {
        (0, 0) => String::new(),
        (a, 0) => format!("length^{a}"),
        (0, b) => format!("length^({b}D)"),
        (a, b) => format!("length^({a}{b:+}D)"),
    };
    let parts = [
        length,
        if units.mass == 0 { String::new() } else { format!("mass^{}", units.mass) },
        if units.viscosity == 0 { String::new() } else { format!("viscosity^{}", units.viscosity) },
    ];
    let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    if parts.is_empty() { "a pure number".into() } else { format!("something in {}", parts.join(" ")) }
}
