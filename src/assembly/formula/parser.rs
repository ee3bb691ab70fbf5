//! Parser from tokens to a formula, by precedence climbing.
//!
//! Nodes are stored in a flat list, operands before the operations that use them. Later passes therefore need no recursion, and a sum of
//! ten thousand terms is as harmless as a sum of two.

use std::ops::Range;

use crate::assembly::formula::error::{FormulaError, FormulaFault};
use crate::assembly::formula::functions::{Binary, CONSTANTS, Callable, Unary};
use crate::assembly::formula::lexer::{Token, tokens};
use sensitol_numeric::names::nearest;
use sensitol_numeric::unit::Unit;

/// Formula as it was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    pub(super) text: String,
    pub(super) nodes: Vec<(Node, Range<usize>)>,
    /// Units of numbers that have one, by node.
    units: Vec<(usize, Unit)>,
}

/// Part of a formula. Operands are indices of earlier nodes.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Node {
    Number(f64),
    Name(String),
    Unary(Unary, usize),
    Binary(Binary, usize, usize),
    If(usize, usize, usize),
}

/// Greatest depth of nested parentheses, signs and powers.
const DEEPEST: usize = 256;

impl Formula {
    /// Parses a formula.
    ///
    /// # Errors
    /// Fails at the first fault, with its position in the text.
    ///
    /// ```
    /// use sensitol::assembly::formula::Formula;
    /// assert!(Formula::parse("f - r + (R - r)*sin(phi)").is_ok());
    /// let error = Formula::parse("f - (r + 1").unwrap_err();
    /// assert_eq!((error.to_string().as_str(), error.span), ("this `(` is never closed", 4..5));
    /// ```
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        let tokens = tokens(text)?;
        if tokens.is_empty() {
            return Err(FormulaError { span: 0..text.len(), fault: FormulaFault::Empty });
        }
        let mut parser = Parser { tokens: &tokens, next: 0, end: text.len(), nodes: Vec::new(), units: Vec::new() };
        parser.expression(0, 0)?;
        match parser.peek() {
            None => Ok(Self { text: text.to_owned(), nodes: parser.nodes, units: parser.units }),
            Some(Token::Close) => Err(parser.error_here(FormulaFault::UnopenedParenthesis)),
            Some(Token::Comma) => Err(parser.error_here(FormulaFault::StrayComma)),
            Some(_) => Err(parser.error_here(FormulaFault::MissingOperator { before: parser.shown() })),
        }
    }

    /// Returns the text that was parsed.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Returns the unit of the number at a node.
    pub(super) fn unit_of(&self, node: usize) -> Option<&Unit> {
        self.units.iter().find(|(place, _)| *place == node).map(|(_, unit)| unit)
    }

    /// True if no number has a unit.
    pub(super) fn has_no_units(&self) -> bool {
        self.units.is_empty()
    }

    /// Returns the formula with each name multiplied by a factor, and the result divided by `result`. Numbers with units are converted to
    /// SI.
    pub fn converted(&self, factor: &dyn Fn(&str) -> f64, result: f64) -> Self {
        let mut nodes: Vec<(Node, Range<usize>)> = Vec::with_capacity(self.nodes.len());
        let mut places = Vec::with_capacity(self.nodes.len());
        let mut push = |node: Node, span: &Range<usize>| {
            nodes.push((node, span.clone()));
            nodes.len() - 1
        };
        for (index, (node, span)) in self.nodes.iter().enumerate() {
            let place = match node {
                Node::Number(value) => {
                    push(Node::Number(value * self.unit_of(index).map_or(1.0, |unit| unit.scale)), span)
                }
                Node::Name(name) => {
                    let (own, by) = (push(Node::Name(name.clone()), span), factor(name));
                    if by == 1.0 {
                        own
                    } else {
                        let by = push(Node::Number(by), span);
                        push(Node::Binary(Binary::Multiply, own, by), span)
                    }
                }
                Node::Unary(function, a) => push(Node::Unary(*function, places[*a]), span),
                Node::Binary(function, a, b) => push(Node::Binary(*function, places[*a], places[*b]), span),
                Node::If(condition, then, otherwise) => {
                    push(Node::If(places[*condition], places[*then], places[*otherwise]), span)
                }
            };
            places.push(place);
        }
        if result != 1.0 {
            let (last, whole) = (places[places.len() - 1], 0..self.text.len());
            let by = push(Node::Number(result), &whole);
            push(Node::Binary(Binary::Divide, last, by), &whole);
        }
        Self { text: self.text.clone(), nodes, units: Vec::new() }
    }

    /// Returns every name with its position. A name that is used twice appears twice.
    pub fn names(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        self.nodes.iter().filter_map(|(node, span)| match node {
            Node::Name(name) => Some((name.as_str(), span.clone())),
            _ => None,
        })
    }
}

/// True if formulas use this name for a function or constant.
///
/// ```
/// use sensitol::assembly::formula::is_reserved;
/// assert!(is_reserved("pi") && is_reserved("hypot") && !is_reserved("e") && !is_reserved("g"));
/// ```
pub fn is_reserved(name: &str) -> bool {
    Callable::of_name(name).is_some() || CONSTANTS.iter().any(|&(constant, _)| constant == name)
}

struct Parser<'a> {
    tokens: &'a [(Token, Range<usize>)],
    next: usize,
    end: usize,
    nodes: Vec<(Node, Range<usize>)>,
    units: Vec<(usize, Unit)>,
}

/// Binding strength of a sign: more than `*`, less than `^`, so that `-x^2` is `-(x^2)`.
const SIGN: u8 = 5;

fn infix(token: &Token) -> Option<(Binary, u8, u8)> {
    let Token::Operator(sign) = token else { return None };
    Some(match *sign {
        "<" => (Binary::Less, 1, 2),
        "<=" => (Binary::LessEqual, 1, 2),
        ">" => (Binary::Greater, 1, 2),
        ">=" => (Binary::GreaterEqual, 1, 2),
        "==" => (Binary::Equal, 1, 2),
        "!=" => (Binary::NotEqual, 1, 2),
        "+" => (Binary::Add, 2, 3),
        "-" => (Binary::Subtract, 2, 3),
        "*" => (Binary::Multiply, 4, 5),
        "/" => (Binary::Divide, 4, 5),
        "^" => (Binary::Power, 7, 6),
        _ => return None,
    })
}

impl Parser<'_> {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next).map(|(token, _)| token)
    }

    fn here(&self) -> Range<usize> {
        self.tokens.get(self.next).map_or(self.end..self.end, |(_, span)| span.clone())
    }

    fn error_here(&self, fault: FormulaFault) -> FormulaError {
        FormulaError { span: self.here(), fault }
    }

    fn shown(&self) -> String {
        match self.peek() {
            None => "the end".to_owned(),
            Some(Token::Number(value)) => format!("`{value}`"),
            Some(Token::Name(name, _)) => format!("`{name}`"),
            Some(Token::Operator(sign)) => format!("`{sign}`"),
            Some(Token::Open) => "`(`".to_owned(),
            Some(Token::Close) => "`)`".to_owned(),
            Some(Token::Comma) => "`,`".to_owned(),
            Some(Token::Unit(unit)) => format!("`[{unit}]`"),
        }
    }

    fn push(&mut self, node: Node, span: Range<usize>) -> usize {
        self.nodes.push((node, span));
        self.nodes.len() - 1
    }

    fn span_of(&self, node: usize) -> Range<usize> {
        self.nodes[node].1.clone()
    }

    /// Parses an expression whose operators bind at least as tightly as `floor`.
    fn expression(&mut self, floor: u8, depth: usize) -> Result<usize, FormulaError> {
        if depth > DEEPEST {
            return Err(self.error_here(FormulaFault::TooDeep { limit: DEEPEST }));
        }
        let mut left = self.operand(depth)?;
        let mut compared = false;
        while let Some((operator, binds_left, binds_right)) = self.peek().and_then(infix) {
            if binds_left < floor {
                break;
            }
            if binds_left == 1 && std::mem::replace(&mut compared, true) {
                return Err(self.error_here(FormulaFault::ChainedComparison));
            }
            self.next += 1;
            let right = self.expression(binds_right, depth + 1)?;
            let span = self.span_of(left).start..self.span_of(right).end;
            left = self.push(Node::Binary(operator, left, right), span);
        }
        Ok(left)
    }

    fn operand(&mut self, depth: usize) -> Result<usize, FormulaError> {
        let span = self.here();
        match self.peek().cloned() {
            Some(Token::Number(value)) => {
                self.next += 1;
                let node = self.push(Node::Number(value), span.clone());
                if let Some(Token::Unit(text)) = self.peek().cloned() {
                    let place = self.here();
                    let unknown = || FormulaError {
                        span: place.clone(),
                        fault: FormulaFault::UnknownUnit { text: text.clone() },
                    };
                    self.units.push((node, Unit::parse(&text).ok_or_else(unknown)?));
                    self.nodes[node].1 = span.start..place.end;
                    self.next += 1;
                }
                Ok(node)
            }
            Some(Token::Name(name, quoted)) => {
                self.next += 1;
                self.name(name, quoted, span, depth)
            }
            Some(Token::Operator(sign @ ("-" | "+"))) => {
                self.next += 1;
                let operand = self.expression(SIGN, depth + 1)?;
                if sign == "+" {
                    return Ok(operand);
                }
                let span = span.start..self.span_of(operand).end;
                Ok(self.push(Node::Unary(Unary::Negate, operand), span))
            }
            Some(Token::Open) => {
                self.next += 1;
                let inner = self.expression(0, depth + 1)?;
                let close = self.close(span.clone())?;
                self.nodes[inner].1 = span.start..close;
                Ok(inner)
            }
            _ => Err(self.error_here(FormulaFault::MissingOperand { before: self.shown() })),
        }
    }

    fn name(&mut self, name: String, quoted: bool, span: Range<usize>, depth: usize) -> Result<usize, FormulaError> {
        let callable = if quoted { None } else { Callable::of_name(&name) };
        if self.peek() == Some(&Token::Open) {
            let Some(callable) = callable else {
                let nearest = nearest(&name, Callable::names()).map(str::to_owned);
                return Err(FormulaError { span, fault: FormulaFault::UnknownFunction { name, nearest } });
            };
            return self.call(name, callable, span, depth);
        }
        if callable.is_some() {
            return Err(FormulaError { span, fault: FormulaFault::BareFunction { name } });
        }
        let constant = CONSTANTS.iter().find(|&&(constant, _)| !quoted && constant == name);
        Ok(match constant {
            Some(&(_, value)) => self.push(Node::Number(value), span),
            None => self.push(Node::Name(name), span),
        })
    }

    fn call(
        &mut self,
        name: String,
        callable: Callable,
        span: Range<usize>,
        depth: usize,
    ) -> Result<usize, FormulaError> {
        let open = self.here();
        self.next += 1;
        let mut arguments = Vec::new();
        if self.peek() != Some(&Token::Close) {
            arguments.push(self.expression(0, depth + 1)?);
            while self.peek() == Some(&Token::Comma) {
                self.next += 1;
                arguments.push(self.expression(0, depth + 1)?);
            }
        }
        let span = span.start..self.close(open)?;
        let found = arguments.len();
        let (least, most) = callable.arity();
        if found < least || most.is_some_and(|most| found > most) {
            let expected = match callable {
                Callable::Unary(_) => "1",
                Callable::Binary(_) => "2",
                Callable::Fold(_) => "2 or more",
                Callable::If => "3 (condition, then, else)",
            };
            return Err(FormulaError { span, fault: FormulaFault::WrongArity { name, expected, found } });
        }
        Ok(match callable {
            Callable::Unary(function) => self.push(Node::Unary(function, arguments[0]), span),
            Callable::If => self.push(Node::If(arguments[0], arguments[1], arguments[2]), span),
            Callable::Binary(function) | Callable::Fold(function) => {
                let mut folded = arguments[0];
                for &argument in &arguments[1..] {
                    folded = self.push(Node::Binary(function, folded, argument), span.clone());
                }
                folded
            }
        })
    }

    /// Consumes the `)` that belongs to the `(` at `open`, and returns its end.
    fn close(&mut self, open: Range<usize>) -> Result<usize, FormulaError> {
        match self.peek() {
            Some(Token::Close) => {
                let end = self.here().end;
                self.next += 1;
                Ok(end)
            }
            None => Err(FormulaError { span: open, fault: FormulaFault::UnclosedParenthesis }),
            Some(Token::Comma) => Err(self.error_here(FormulaFault::StrayComma)),
            Some(_) => Err(self.error_here(FormulaFault::MissingOperator { before: self.shown() })),
        }
    }
}
